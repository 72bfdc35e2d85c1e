// Makes dist/page.html from the sources: one page with style, script and licences in it, and a mark
// where a run's data go. With --check: fails unless the committed page is what the sources make.

import { readFileSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const OUT = "dist/page.html";

const read = (path) => readFileSync(new URL(path, import.meta.url), "utf8");

const bundled = await build({
  absWorkingDir: new URL(".", import.meta.url).pathname,
  entryPoints: ["src/main.ts"],
  bundle: true,
  format: "iife",
  minify: true,
  legalComments: "inline",
  target: "es2022",
  write: false,
});
const style = await build({
  absWorkingDir: new URL(".", import.meta.url).pathname,
  entryPoints: ["src/style.css"],
  minify: true,
  write: false,
});

// A script element ends at the first "</script", wherever that is.
const script = bundled.outputFiles[0].text.replaceAll("</script", "<\\/script").trim();
const licence = read("node_modules/three/LICENSE").replaceAll("&", "&amp;").replaceAll("<", "&lt;").trim();
const page = read("src/page.html")
  .replace("/*STYLE*/", () => style.outputFiles[0].text.trim())
  .replace("/*LICENCES*/", () => licence)
  .replace("/*SCRIPT*/", () => script);

if (process.argv.includes("--check")) {
  if (read(OUT) !== page) {
    console.error(`${OUT} is not what the sources make: run \`npm run build\` and commit it`);
    process.exit(1);
  }
  console.log(`${OUT} is what the sources make (${page.length} bytes)`);
} else {
  writeFileSync(new URL(OUT, import.meta.url), page);
  console.log(`${OUT}: ${page.length} bytes`);
}
