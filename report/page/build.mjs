// Makes one HTML file of page.html, the styles and the scripts, and one script that only maps in space need: node build.mjs OUT SPACE_OUT
import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";

const [out, spaceOut] = process.argv.slice(2);
const bundle = async (entry) => {
  const result = await build({
    entryPoints: [entry],
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2021",
    legalComments: "inline",
    write: false,
    logLevel: "warning",
  });
  return result.outputFiles[0].text.trim();
};

const parts = { style: await bundle("src/style.css"), script: await bundle("src/main.ts") };
const space = await bundle("src/space_view.ts");
// The browser ends the element where it sees its end tag, also within a string.
for (const [name, text] of [...Object.entries(parts), ["script", space]]) {
  if (text.toLowerCase().includes(`</${name}`)) throw new Error(`the ${name} ends its own element`);
}
writeFileSync(spaceOut, space);
const page = readFileSync("src/page.html", "utf8");
const marked = /<!--page:(style|script)-->/g;
writeFileSync(out, page.replace(marked, (_, name) => `<${name}>${parts[name]}</${name}>`));
