/**
 * Makes printprep/page/assets/viewer.js from src/ and three.js.
 *
 *   node build.js           writes it, and the licence of three.js beside it
 *   node build.js --check   fails where the file in the repository is another one
 */
import { readFileSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const ASSETS = new URL("../printprep/page/assets/", import.meta.url);

const { outputFiles } = await build({
  entryPoints: ["src/main.js"],
  bundle: true,
  minify: true,
  write: false,
  format: "iife",
  target: ["es2022"],
  charset: "ascii",
  legalComments: "inline",
});
const { version } = JSON.parse(readFileSync("node_modules/three/package.json", "utf8"));
const licence = readFileSync("node_modules/three/LICENSE", "utf8");
const head = `/* printprep's viewer (GPL-3.0-or-later) with three.js ${version} (MIT, see THREE-LICENSE.txt) */\n`;
const made = new Map([
  ["viewer.js", head + outputFiles[0].text],
  ["THREE-LICENSE.txt", `three.js ${version}, bundled in viewer.js\n\n${licence}`],
]);

let stale = false;
for (const [name, content] of made) {
  const place = new URL(name, ASSETS);
  if (process.argv.includes("--check")) {
    if (readFileSync(place, "utf8") !== content) {
      console.error(`printprep/page/assets/${name} is not what src/ makes: run npm run build`);
      stale = true;
    }
  } else {
    writeFileSync(place, content);
  }
}
process.exitCode = stale ? 1 : 0;
