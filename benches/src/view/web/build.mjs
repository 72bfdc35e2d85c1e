// Makes dist/page.html from the sources: one page with style, script and licences in it, and a mark
// where a run's data go. With --check: fails unless the committed page is what the sources make.
// With --play PROGRAM.wasm FILE: makes the page to play with, which has that program and meshes in
// it.

import { readFileSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const OUT = "dist/page.html";

const read = (path) => readFileSync(new URL(path, import.meta.url), "utf8");

const [flag, program, file] = process.argv.slice(2);
const plays = flag === "--play";

const bundle = async (entry) => {
  const bundled = await build({
    absWorkingDir: new URL(".", import.meta.url).pathname,
    entryPoints: [entry],
    bundle: true,
    format: "iife",
    minify: true,
    legalComments: "inline",
    target: "es2022",
    write: false,
  });
  return bundled.outputFiles[0].text;
};
const viewer = await bundle("src/main.ts");
const style = await build({
  absWorkingDir: new URL(".", import.meta.url).pathname,
  entryPoints: ["src/style.css"],
  minify: true,
  write: false,
});

// A script element ends at the first "</script", wherever that is.
const script = (plays ? await bundle("src/play.ts") : viewer).replaceAll("</script", "<\\/script").trim();
const licence = read("node_modules/three/LICENSE").replaceAll("&", "&amp;").replaceAll("<", "&lt;").trim();
const page = read("src/page.html")
  .replace("/*STYLE*/", () => style.outputFiles[0].text.trim())
  .replace("/*LICENCES*/", () => licence)
  .replace("/*SCRIPT*/", () => script);

if (plays) {
  const files = { "viewer.js": viewer, "sdop-live.wasm": readFileSync(resolve(program)) };
  for (const mesh of ["spot.tri", "teapot.tri", "bunny-4k.tri"]) files[mesh] = read(`../../../../data/meshes/${mesh}`);
  const carried = Object.entries(files).map(([name, content]) => {
    const text = gzipSync(content, { level: 9 }).toString("base64");
    return `<script type="text/plain" data-file="${name}">${text}</script>\n`;
  });
  const whole = page
    .replace("script-src 'unsafe-inline'", "$& 'wasm-unsafe-eval'")
    .replace("<title>sdop view</title>", "<title>sdop: collision culling to play with</title>")
    .replace("<!--DATA-->", () => carried.join(""));
  writeFileSync(resolve(file), whole);
  console.log(`${file}: ${whole.length} bytes`);
} else if (flag === "--check") {
  if (read(OUT) !== page) {
    console.error(`${OUT} is not what the sources make: run \`npm run build\` and commit it`);
    process.exit(1);
  }
  console.log(`${OUT} is what the sources make (${page.length} bytes)`);
} else {
  writeFileSync(new URL(OUT, import.meta.url), page);
  console.log(`${OUT}: ${page.length} bytes`);
}
