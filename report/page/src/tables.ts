// What is told in tables: the summary of a run, configurations and where the results are from.
import { axesOf, differingPaths, groupOf, groupsOf, identityOf, type Group } from "./answers";
import type { Report, Run } from "./data";
import { table } from "./data_table";
import { el, replace, section } from "./elements";
import { count, fixed, proportion } from "./numbers";
import { explained } from "./words";

export function summarySection({ summary: s }: Run): HTMLElement | null {
  if (!s) return null;
  const { count: all, right, wrong, undecided, declared_without_reference: declared = 0, failed = 0 } = s.trials;
  // Without a trial, or a reference to judge declarations by, rates say nothing.
  const hasRates = all > 0 && (right + wrong > 0 || declared === 0);
  const rows: [string, string][] = [
    ["experiment, seed", `${s.name}, ${s.seed}`],
    ["trials", count(all)],
    ["right, wrong, undecided", `${right}, ${wrong}, ${undecided}`],
    ...(declared > 0 ? [["declared, not judged", count(declared)] as [string, string]] : []),
    ["failed", count(failed)],
    ["success", hasRates ? proportion(s.success_rate) : "–"],
    ["wrong", hasRates ? proportion(s.false_rate) : "–"],
    ["steps to localize, median", right > 0 ? fixed(s.steps_to_localize.median, 1) : "–"],
    ["distance to localize, median", right > 0 ? `${fixed(s.distance_to_localize_m.median, 2)} m` : "–"],
    ["error when localized, median", right > 0 ? `${fixed(s.translation_error_m.median, 3)} m, ${fixed(s.rotation_error_deg.median, 2)}°` : "–"],
    ["wall time of a step, median (95 %)", s.steps > 0 ? `${fixed(s.step_ms.median, 1)} ms (${fixed(s.step_ms.p95, 1)} ms)` : "–"],
    ["matching, median", s.steps > 0 ? `${fixed(s.stage_ms.match.median, 1)} ms` : "–"],
    ["points of the map", count(s.map.points)],
    ["memory, largest", `${fixed(s.peak_rss_mb, 0)} MiB`],
  ];
  return section(
    "summary",
    "Summary",
    !s.complete && el("p", { class: "warning" }, "Interrupted, so that trials are missing."),
    table("summary", ["", ""], rows.map(([title, value]) => [explained(el("span", {}, title)), value]), "facts"),
    el("p", { class: "note" }, "Intervals are those after Wilson, 95 %."),
  );
}

/** What runs say, each thing once: alone where all say the same, else with the names of those that say it. */
function saidBy(runs: Run[], tell: (run: Run) => Node | string | null, keyOf: (run: Run) => string | undefined): Node | string {
  const groups = new Map<string | undefined, Run[]>();
  for (const run of runs) {
    const key = keyOf(run);
    const its = groups.get(key);
    if (its) its.push(run);
    else groups.set(key, [run]);
  }
  if (groups.size === 1) return tell(runs[0]) ?? "–";
  const said = [...groups.values()].flatMap((its) => {
    const value = tell(its[0]);
    return value === null ? [] : [el("li", {}, el("mark", {}, value), " ", el("small", {}, namesOf(its, runs)))];
  });
  return el("ul", { class: "said" }, ...said);
}

const mostNames = 3;
/** Settings beyond these are shown when they are asked for. */
const mostSettings = 40;

const nameable = new WeakMap<Run[], Group[][]>();

/** Ways to divide runs into such as have a name. */
function groupingsOf(all: Run[]): Group[][] {
  const known = nameable.get(all);
  if (known) return known;
  const byAxis = axesOf(all).map(({ valueOf, values }) => values.map((value) => groupOf(value, all.filter((run) => valueOf(run) === value))));
  const groupings = [groupsOf(all, "setting"), ...byAxis, groupsOf(all, "run")];
  nameable.set(all, groupings);
  return groupings;
}

/** All runs of a method, a case and so on go by that. */
function namesOf(some: Run[], all: Run[]): string {
  const chosen = new Set(some);
  const names = (groups: Group[]): string[] | null => {
    const whole = groups.filter((group) => group.runs.every((run) => chosen.has(run)));
    return whole.reduce((n, group) => n + group.runs.length, 0) === some.length ? whole.map(({ name }) => name) : null;
  };
  const [shortest] = groupingsOf(all).map(names).filter((told) => told !== null).sort((a, b) => a.length - b.length);
  const told = shortest.slice(0, mostNames).join(", ");
  return shortest.length <= mostNames ? told : `${told} and ${shortest.length - mostNames} more`;
}

/** Values by path; what differs between runs comes first and is marked. */
export function configurationSection(runs: Run[]): HTMLElement {
  const paths = [...new Set(runs.flatMap((run) => Object.keys(run.settings)))].sort();
  const different = differingPaths(runs);
  const same = paths.filter((path) => !different.includes(path));
  const filter = el("input", { type: "search", placeholder: "part of a name", "aria-label": "Show settings with this in their name" });
  const onlyDifferent = el("input", { type: "checkbox", checked: different.length > 0 });
  const target = el("div", {});
  let most = mostSettings;
  const fill = (): void => {
    const chosen = (onlyDifferent.checked ? different : [...different, ...same]).filter((path) =>
      path.toLowerCase().includes(filter.value.toLowerCase()),
    );
    const told = (path: string): Node | string => saidBy(runs, (run) => run.settings[path]?.text ?? null, (run) => identityOf(run, path));
    const showAll = (): void => {
      most = Infinity;
      fill();
    };
    replace(
      target,
      table("configuration", ["", ""], chosen.slice(0, most).map((path) => [path, told(path)]), "facts"),
      chosen.length > most && el("button", { type: "button", class: "all", click: showAll }, `all ${count(chosen.length)} settings`),
    );
  };
  filter.addEventListener("input", fill);
  onlyDifferent.addEventListener("change", fill);
  fill();
  return section(
    "configuration",
    "Configuration",
    el(
      "p",
      { class: "controls" },
      filter,
      runs.length > 1 &&
        el("label", {}, onlyDifferent, ` only what differs (${different.length} of ${paths.length})`),
    ),
    target,
  );
}

export function provenanceSection(report: Report): HTMLElement {
  const runs = report.runs.filter((run) => run.provenance);
  const keys = [...new Set(runs.flatMap((run) => Object.keys(run.provenance ?? {})))];
  const told = (value: unknown): Node | string | null => {
    if (value === undefined) return null;
    if (typeof value !== "object" || value === null) return String(value);
    const entries = Array.isArray(value) ? value.map(String) : Object.entries(value).map(([k, v]) => `${k}: ${typeof v === "object" ? JSON.stringify(v) : String(v)}`);
    return entries.length === 0 ? "none" : el("ul", { class: "files" }, ...entries.map((entry) => el("li", {}, entry)));
  };
  const row = (name: string, value: (run: Run) => unknown): (Node | string)[] => [
    name,
    saidBy(runs, (run) => told(value(run)), (run) => JSON.stringify(value(run))),
  ];
  return section(
    "provenance",
    "Provenance",
    table("provenance", ["", ""], [row("folder", ({ folder }) => folder), ...keys.map((key) => row(key.replaceAll("_", " "), ({ provenance }) => provenance?.[key]))], "facts"),
    el("p", { class: "note" }, `Made by ${report.generator}.`),
  );
}
