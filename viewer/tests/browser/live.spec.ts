// A solve that is watched, and its server.

import { type ChildProcess, spawn } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { get, type IncomingMessage, request } from "node:http";
import { connect } from "node:net";
import { networkInterfaces } from "node:os";
import { file, ISOLUX, OUT, table } from "./files";
import { expect, open, read, test } from "./page";

/** Starts a solve and waits for its address. */
async function solve(...words: string[]): Promise<{ solve: ChildProcess; address: URL; ended: Promise<number | null> }> {
  const solve = spawn(ISOLUX, ["solve", "cornell-box", "--live", "--no-open", ...words], { cwd: OUT, stdio: ["ignore", "ignore", "pipe"] });
  const ended = new Promise<number | null>((done) => solve.on("exit", done));
  let said = "";
  const address = await new Promise<URL>((found, failed) => {
    solve.stderr!.on("data", (text) => {
      said += text;
      const match = said.match(/http:\/\/127\.0\.0\.1:\d+\//);
      if (match) found(new URL(match[0]));
    });
    solve.on("exit", () => failed(new Error(said)));
  });
  return { solve, address, ended };
}

/** The status of an answer. */
function status(address: URL, path: string, options: { method?: string; host?: string }): Promise<number> {
  const { method = "GET", host = address.host } = options;
  return new Promise((done, failed) => {
    const asked = request({ host: address.hostname, port: address.port, path, method, headers: { Host: host } }, (answer: IncomingMessage) => {
      answer.resume();
      done(answer.statusCode!);
    });
    asked.on("error", failed);
    asked.end();
  });
}

test("a solve gets better while one watches, and Ctrl-C keeps it", async ({ page }) => {
  const { solve: running, address, ended } = await solve("--elements", "5000", "--time", "10min", "-o", "stopped.csv");
  try {
    await open(page, address.href);
    const live = page.locator("#live");
    await expect(live).toContainText("solving");
    const revision = async () => Number(await live.getAttribute("data-revision"));
    const camera = () => page.evaluate(() => JSON.stringify((window as any).isolux.viewer.camera.camera.position));
    await page.mouse.move(400, 400);
    await page.mouse.wheel(0, -300);
    const [first, where] = [await revision(), await camera()];
    const { element } = await read(page, 500, 300);
    await expect.poll(revision).toBeGreaterThan(first + 2);
    // The reading on the card follows: its error is known after two replicates, and gets smaller then.
    const card = page.locator("#reading");
    const error = async () => Number(await card.getAttribute("data-error"));
    await expect.poll(error).toBeGreaterThan(0);
    const earlier = await error();
    await expect.poll(error).toBeLessThan(0.8 * earlier);
    expect(Number(await card.getAttribute("data-element"))).toBe(element);
    expect(await camera()).toBe(where);

    for (const path of ["/", "/revision", "/light", "/surfaces"]) expect(await status(address, path, {})).toBe(200);
    for (const path of ["/etc/passwd", "/../out/room.csv", "/room.csv", "/light?a", "//", "/stopped.csv"]) {
      expect(await status(address, path, {}), path).toBe(404);
    }
    for (const method of ["POST", "PUT", "DELETE", "OPTIONS"]) expect(await status(address, "/light", { method })).toBe(404);
    for (const host of ["evil.example", `evil.example:${address.port}`, "127.0.0.1"]) expect(await status(address, "/light", { host })).toBe(404);
    await isOnLoopbackOnly(Number(address.port));
  } finally {
    running.kill("SIGINT");
  }
  expect(await ended).toBe(130);
  expect(table("stopped.csv").length).toBeGreaterThan(4000);
  await expect(page.locator("#live")).toContainText("ended");
});

test("the result stays until Ctrl-C, and is that of the files", async ({ page }) => {
  const { solve: running, address, ended } = await solve("--elements", "2000", "--rays", "300k", "-o", "watched.csv");
  try {
    await open(page, address.href);
    await expect(page.locator("#live.finished")).toContainText("done");
    expect(existsSync(file("watched.csv"))).toBe(true);
    const rows = table("watched.csv");
    const { element, lux } = await read(page, 500, 300);
    expect(lux / Number(rows[element]!.irradiance_luminance)).toBeCloseTo(1, 5);
    await new Promise((done) => setTimeout(done, 500));
    expect(running.exitCode).toBeNull();
  } finally {
    running.kill("SIGINT");
  }
  expect(await ended).toBe(0);
});

test("a port that is taken is known before the work", async () => {
  const { solve: running, address, ended } = await solve("--elements", "500", "--rays", "10k");
  await new Promise((done) => get(address, (answer) => answer.resume().on("end", done)));
  const second = spawn(ISOLUX, ["solve", "cornell-box", "--live", "--no-open", "--port", address.port, "-o", "never.csv"], { cwd: OUT });
  let said = "";
  second.stderr.on("data", (text) => (said += text));
  expect(await new Promise((done) => second.on("exit", done))).toBe(1);
  expect(said).toContain(`port ${address.port}`);
  expect(existsSync(file("never.csv"))).toBe(false);
  running.kill("SIGINT");
  await ended;
});

/** Nobody but this machine can connect. */
async function isOnLoopbackOnly(port: number): Promise<void> {
  const others = Object.values(networkInterfaces()).flat().filter((one) => one && !one.internal && one.family === "IPv4");
  for (const { address } of others as { address: string }[]) {
    const connected = new Promise<boolean>((done) => {
      const socket = connect(port, address, () => done(true)).on("error", () => done(false));
      setTimeout(() => socket.destroy(), 1000);
    });
    expect(await connected, address).toBe(false);
  }
  if (!existsSync("/proc/net/tcp")) return;
  const listening = readFileSync("/proc/net/tcp", "utf8").split("\n").filter((line) => / 0A /.test(line));
  const here = listening.map((line) => line.trim().split(/\s+/)[1]!).filter((local) => parseInt(local.split(":")[1]!, 16) === port);
  expect(here).toEqual([`0100007F:${port.toString(16).toUpperCase().padStart(4, "0")}`]);
}
