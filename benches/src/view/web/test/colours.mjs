// How many pixels of a picture have which colour; the browser itself decodes the PNG.

import { Tab } from "./chromium.mjs";

/**
 * Evaluates pictures in a separate page: `body` is the body of a function of their pixels, `seen`.
 */
async function judged(browser, pngs, width, height, body) {
  const tab = await Tab.open(browser.port);
  try {
    const urls = pngs.map((png) => `data:image/png;base64,${png.toString("base64")}`);
    return await tab.read(`(async () => {
      const seen = [];
      for (const url of ${JSON.stringify(urls)}) {
        const image = new Image();
        image.src = url;
        await image.decode();
        const context = new OffscreenCanvas(${width}, ${height}).getContext("2d");
        context.drawImage(image, 0, 0);
        seen.push(context.getImageData(0, 0, ${width}, ${height}).data);
      }
      ${body}
    })()`);
  } finally {
    await tab.close();
  }
}

/** Counts over the picture's left `width` and upper `height` pixels. */
export function colours(browser, png, width, height) {
  return judged(browser, [png], width, height, `
    const [data] = seen;
    const counts = { blue: 0, orange: 0, red: 0, dark: 0, light: 0, teal: 0, purple: 0 };
    for (let at = 0; at < data.length; at += 4) {
      const [r, g, b] = [data[at], data[at + 1], data[at + 2]];
      if (b > r + 70 && b > 90) counts.blue++;
      if (r > b + 90 && g > b + 50 && r > 110) counts.orange++;
      if (r > g + 90 && r > b + 90) counts.red++;
      if (g > r + 60 && b > r + 60 && Math.abs(g - b) < 40) counts.teal++;
      if (r > g + 45 && b > g + 45 && Math.abs(r - b) < 60) counts.purple++;
      if (r + g + b < 120) counts.dark++;
      if (r + g + b > 690) counts.light++;
    }
    return counts;`);
}

/**
 * Of the pixels that are coloured in the first picture, how many have about the same colour in the
 * second.
 */
export function kept(browser, first, second, width, height) {
  return judged(browser, [first, second], width, height, `
    const [before, after] = seen;
    let [coloured, same] = [0, 0];
    for (let at = 0; at < before.length; at += 4) {
      const here = before.subarray(at, at + 3);
      if (Math.max(...here) - Math.min(...here) < 60) continue;
      coloured++;
      if (here.every((value, channel) => Math.abs(value - after[at + channel]) < 24)) same++;
    }
    return { coloured, same };`);
}
