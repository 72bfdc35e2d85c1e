// Bundles the tests of single modules for node and runs them.

import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { spawnSync } from "node:child_process";
import { build } from "esbuild";

const directory = mkdtempSync(join(tmpdir(), "sdop-view-unit-"));
const outfile = join(directory, "unit.mjs");
await build({
  absWorkingDir: new URL("..", import.meta.url).pathname,
  entryPoints: ["test/unit.ts"],
  bundle: true,
  platform: "node",
  format: "esm",
  outfile,
});
const { status } = spawnSync(process.execPath, ["--test", "--test-reporter=dot", outfile], { stdio: "inherit" });
rmSync(directory, { recursive: true });
process.exit(status ?? 1);
