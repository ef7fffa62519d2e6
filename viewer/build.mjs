// Builds the page: one file, dist/viewer.html, with style and program in it. Cargo puts it into isolux (crates/io/build.rs).

import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";

const bundled = await build({
  entryPoints: ["src/main.ts"],
  bundle: true,
  minify: true,
  write: false,
  format: "iife",
  target: "es2022",
  loader: { ".glsl": "text" },
  legalComments: "inline",
});
const [program] = bundled.outputFiles;
const page = await readFile("src/viewer.html", "utf8");
const style = await readFile("src/style.css", "utf8");
// A script must not end itself, nor may `$` in it mean anything to replace().
const text = program.text.replaceAll("</script", "<\\/script");
const whole = page.replace("/* style.css */", () => style).replace("/* viewer.js */", () => text);
await writeFile("dist/viewer.html", whole);
console.log(`dist/viewer.html: ${Math.round(whole.length / 1000)} kB`);
