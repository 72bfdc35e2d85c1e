// A headless Chromium with software rendering, driven over its DevTools protocol.

import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import CDP from "chrome-remote-interface";

const NAMES = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/** The installed browser: $CHROMIUM, or the first of the usual names on the path. */
export function find() {
  const directories = (process.env.PATH ?? "").split(":");
  const paths = NAMES.flatMap((name) => directories.map((directory) => join(directory, name)));
  const found = process.env.CHROMIUM ?? paths.find((path) => existsSync(path));
  if (!found) throw new Error("no Chromium here: install it (Debian: apt-get install chromium) or set CHROMIUM");
  return found;
}

/** Starts a browser; `close` ends it and removes what it wrote. */
export async function launch() {
  const profile = mkdtempSync(join(tmpdir(), "sdop-view-"));
  const options = ["--headless=new", "--remote-debugging-port=0", `--user-data-dir=${profile}`, "--no-first-run"];
  options.push("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-vsync", "--hide-scrollbars");
  options.push("--disable-extensions", "--disable-background-networking", "--mute-audio");
  if (process.getuid?.() === 0) options.push("--no-sandbox"); // Chromium's sandbox refuses root, as in a container
  const browser = spawn(find(), [...options, "about:blank"], { stdio: "ignore", detached: true });
  const ended = new Promise((resolve) => browser.on("exit", resolve));
  const file = join(profile, "DevToolsActivePort");
  for (let waited = 0; !existsSync(file) || !readFileSync(file, "utf8").includes("\n"); waited += 50) {
    if (waited > 20_000 || browser.exitCode !== null) throw new Error("Chromium didn't start");
    await sleep(50);
  }
  const port = Number(readFileSync(file, "utf8").split("\n")[0]);
  return {
    port,
    profile,
    async close() {
      // With all its child processes, which would keep writing into the profile.
      process.kill(-browser.pid, "SIGKILL");
      await ended;
      for (let tries = 0; ; tries++) {
        try {
          rmSync(profile, { recursive: true, force: true });
          return;
        } catch (error) {
          if (tries === 50) throw error;
          await sleep(100);
        }
      }
    },
  };
}

export const sleep = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

/** A tab that notes every error and every request. */
export class Tab {
  errors = [];
  requests = [];

  static async open(port, { width = 1280, height = 800, dark = false, still = false, touch = false } = {}) {
    const target = await CDP.New({ port });
    const tab = new Tab();
    tab.client = await CDP({ port, target });
    const { Runtime, Log, Network, Page, Emulation } = tab.client;
    Runtime.exceptionThrown(({ exceptionDetails: d }) => tab.errors.push(d.exception?.description ?? d.text));
    Runtime.consoleAPICalled(({ type, args }) => {
      if (type === "error" || type === "warning") tab.errors.push(args.map((a) => a.value ?? a.description).join(" "));
    });
    Log.entryAdded(({ entry }) => {
      if (entry.level === "error") tab.errors.push(`${entry.text} ${entry.url ?? ""}`);
    });
    Network.requestWillBeSent(({ request }) => tab.requests.push(request.url));
    await Promise.all([Runtime.enable(), Log.enable(), Network.enable(), Page.enable()]);
    await Emulation.setDeviceMetricsOverride({ width, height, deviceScaleFactor: 1, mobile: touch });
    const features = [
      { name: "prefers-color-scheme", value: dark ? "dark" : "light" },
      { name: "prefers-reduced-motion", value: still ? "reduce" : "no-preference" },
    ];
    await Emulation.setEmulatedMedia({ features });
    return tab;
  }

  /** Loads a page and waits for its first picture or message. */
  async go(url) {
    const loaded = this.client.Page.loadEventFired();
    await this.client.Page.navigate({ url });
    await loaded;
    await this.settle();
  }

  /** The value of an expression in the page; promises are awaited. */
  async read(expression) {
    const { result, exceptionDetails } = await this.client.Runtime.evaluate({
      expression,
      returnByValue: true,
      awaitPromise: true,
    });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** Waits until pending changes are drawn. A tab in the background draws nothing. */
  async settle() {
    await this.client.Page.bringToFront();
    return this.read("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))");
  }

  /** Presses a key; `text` only where it types something. */
  async key(key, { code = key, shift = false } = {}) {
    const modifiers = shift ? 8 : 0;
    const text = key === "Enter" ? "\r" : key.length === 1 ? key : undefined;
    const virtual = { " ": 32, Enter: 13, Escape: 27, Tab: 9, ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40 };
    const windowsVirtualKeyCode = virtual[key];
    await this.client.Input.dispatchKeyEvent({ type: "keyDown", key, code, text, modifiers, windowsVirtualKeyCode });
    await this.client.Input.dispatchKeyEvent({ type: "keyUp", key, code, modifiers, windowsVirtualKeyCode });
    await this.settle();
  }

  async mouse(type, x, y, extra = {}) {
    await this.client.Input.dispatchMouseEvent({ type, x, y, ...extra });
  }

  async click(x, y) {
    await this.mouse("mousePressed", x, y, { button: "left", clickCount: 1 });
    await this.mouse("mouseReleased", x, y, { button: "left", clickCount: 1 });
    await this.settle();
  }

  async screenshot() {
    const { data } = await this.client.Page.captureScreenshot({ format: "png" });
    return Buffer.from(data, "base64");
  }

  async close() {
    await this.client.Page.close();
    await this.client.close();
  }
}
