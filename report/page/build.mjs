// Makes HTML files of page.html, the styles and a script: the page of reports and that of the leaderboard; and one script that only maps in space need: node build.mjs OUT SPACE_OUT BOARD_OUT
import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";

const [out, spaceOut, boardOut] = process.argv.slice(2);
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

const style = await bundle("src/style.css");
const script = await bundle("src/main.ts");
const board = await bundle("src/board.ts");
const space = await bundle("src/space_view.ts");
// The browser ends the element where it sees its end tag, also within a string.
for (const [name, text] of [["style", style], ["script", script], ["script", board], ["script", space]]) {
  if (text.toLowerCase().includes(`</${name}`)) throw new Error(`the ${name} ends its own element`);
}
writeFileSync(spaceOut, space);
const page = readFileSync("src/page.html", "utf8");
const marked = /<!--page:(style|script)-->/g;
const write = (file, parts) => writeFileSync(file, page.replace(marked, (_, name) => `<${name}>${parts[name]}</${name}>`));
write(out, { style, script });
write(boardOut, { style, script: board });
