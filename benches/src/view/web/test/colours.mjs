// How many pixels of a picture have which colour; the browser itself decodes the PNG.

import { Tab } from "./chromium.mjs";

/** Counts over the picture's left `width` and upper `height` pixels. */
export async function colours(browser, png, width, height) {
  const tab = await Tab.open(browser.port);
  try {
    return await tab.read(`(async () => {
      const image = new Image();
      image.src = "data:image/png;base64,${png.toString("base64")}";
      await image.decode();
      const canvas = new OffscreenCanvas(${width}, ${height});
      const context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, ${width}, ${height});
      const seen = { blue: 0, orange: 0, red: 0, dark: 0, light: 0, teal: 0, purple: 0 };
      for (let at = 0; at < data.length; at += 4) {
        const [r, g, b] = [data[at], data[at + 1], data[at + 2]];
        if (b > r + 70 && b > 90) seen.blue++;
        if (r > b + 90 && g > b + 50 && r > 110) seen.orange++;
        if (r > g + 90 && r > b + 90) seen.red++;
        if (g > r + 60 && b > r + 60 && Math.abs(g - b) < 40) seen.teal++;
        if (r > g + 45 && b > g + 45 && Math.abs(r - b) < 60) seen.purple++;
        if (r + g + b < 120) seen.dark++;
        if (r + g + b > 690) seen.light++;
      }
      return seen;
    })()`);
  } finally {
    await tab.close();
  }
}
