// Page size, load time and pictures per second in headless Chromium's software rendering: a
// measurement, not a test.
//
// node test/speed.mjs PAGE…

import { statSync } from "node:fs";
import { resolve } from "node:path";
import { launch, sleep, Tab } from "./chromium.mjs";

const browser = await launch();
try {
  for (const page of process.argv.slice(2)) {
    const tab = await Tab.open(browser.port);
    await tab.go(`file://${resolve(page)}`);
    const opened = await tab.read("sdop.opened");
    await tab.read("sdop.play()");
    await sleep(6000);
    const rate = await tab.read("sdop.rate");
    const megabytes = statSync(page).size / 1e6;
    console.log(`${page}: ${megabytes.toFixed(1)} MB, opens in ${(opened / 1000).toFixed(2)} s, plays ${rate.toFixed(1)} pictures a second`);
    await tab.close();
  }
} finally {
  await browser.close();
}
