import { defineConfig } from "@playwright/test";
import { existsSync } from "node:fs";

/** Where Chromium is: as the variable says, or where Debian and others have it. */
const CHROMIUM = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

export default defineConfig({
  testDir: "tests",
  testMatch: ["browser/*.spec.ts", "lightmap/*.spec.js"],
  outputDir: "test-results",
  globalSetup: "./tests/browser/solve.ts",
  // One at a time: without a graphics card each takes all processors.
  workers: 1,
  timeout: 120_000,
  expect: { timeout: 60_000 },
  reporter: "list",
  use: {
    viewport: { width: 1280, height: 800 },
    launchOptions: {
      executablePath: CHROMIUM.find((path) => path && existsSync(path)),
      args: [
        "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
        "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
      ],
    },
  },
});
