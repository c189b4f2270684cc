// Modules of the page, as tests can call them.
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { workFolder } from "./runs.mjs";

const page = process.env.GLOCAL_PAGE_FOLDER; // as it was built
const { build } = createRequire(join(page, "package.json"))("esbuild");
const work = workFolder();

export async function pageModule(name) {
  const outfile = join(work, `${name}.mjs`);
  await build({ entryPoints: [join(page, "src", `${name}.ts`)], bundle: true, format: "esm", outfile, logLevel: "error" });
  return import(pathToFileURL(outfile).href);
}
