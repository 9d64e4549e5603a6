// Writes the libraries of the pages, with their licences, from the releases that package-lock.json pins.
import { build } from "esbuild";
import { copyFile, readFile } from "node:fs/promises";

const { version, license } = JSON.parse(await readFile("node_modules/three/package.json", "utf-8"));
const [copyright] = (await readFile("node_modules/three/LICENSE", "utf-8")).match(/^Copyright.*$/m);
await build({
  entryPoints: ["three.js"],
  outfile: "three.min.js",
  bundle: true,
  minify: true,
  charset: "utf8",
  format: "iife",
  globalName: "THREE",
  target: "es2022",
  legalComments: "none",
  banner: { js: `/*! three.js ${version}, ${license} licence. ${copyright} */` },
});
for (const name of ["uPlot.iife.min.js", "uPlot.min.css"]) await copyFile(`node_modules/uplot/dist/${name}`, name);
for (const name of ["three", "uplot"]) await copyFile(`node_modules/${name}/LICENSE`, `${name}.LICENSE`);
