// Real runs of the program, and what they leave, read by nobody's code but this.
import { execFileSync, spawn } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

export const program = process.env.GLOCAL_PROGRAM;
export const experiments = join(process.env.GLOCAL_SOURCE_DIR, "configs/experiments");

/** A folder of the test's own, gone when the test program ends. */
export function workFolder() {
  const folder = mkdtempSync(join(tmpdir(), "glocal-browser-"));
  process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

export function glocal(...parameters) {
  return execFileSync(program, parameters, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
}

export function runExperiment(name, out, ...parameters) {
  glocal("run", join(experiments, `${name}.yaml`), "--out", out, "--quiet", ...parameters);
  return out;
}

/** How many trials the journals of an unfinished run have. */
function finishedTrials(unfinished) {
  const journals = join(unfinished, "journal");
  const names = existsSync(journals) ? readdirSync(journals).filter((name) => name.includes(".jsonl")) : [];
  return names.map((name) => (readFileSync(join(journals, name), "latin1").match(/^.{8} trial .*\n/gm) ?? []).length).reduce((sum, n) => sum + n, 0);
}

/** Stops a run as Ctrl-C does, once so many trials are finished. */
export async function interruptedRun(name, out, trials, ...parameters) {
  const run = spawn(program, ["run", join(experiments, `${name}.yaml`), "--out", out, "--quiet", ...parameters], {
    stdio: "ignore",
  });
  const ended = new Promise((resolve) => run.on("exit", resolve));
  const slash = out.lastIndexOf("/");
  const unfinished = join(out.slice(0, slash), `.${out.slice(slash + 1)}.unfinished`);
  while (!(existsSync(join(unfinished, "maps")) && finishedTrials(unfinished) >= trials) && run.exitCode === null)
    await new Promise((resolve) => setTimeout(resolve, 5));
  run.kill("SIGINT");
  return ended;
}

export function report(file, ...folders) {
  glocal("report", ...folders, "-o", file);
  return file;
}

const lines = (file) => readFileSync(file, "utf8").split("\n").filter(Boolean).map((line) => JSON.parse(line));
export const trialsOf = (folder) => lines(join(folder, "trials.jsonl"));
export const stepsOf = (folder, trial) => lines(join(folder, "steps.jsonl")).filter((step) => step.trial === trial);

/** x, y and z of the points of a PCD file as the program writes it. */
export function readPcd(name) {
  const content = readFileSync(name);
  const begin = content.indexOf("DATA binary\n") + "DATA binary\n".length;
  const points = [];
  for (let i = begin; i < content.length; i += 12) {
    const [x, y, z] = [0, 4, 8].map((k) => content.readFloatLE(i + k));
    points.push({ x, y, z });
  }
  return points;
}
