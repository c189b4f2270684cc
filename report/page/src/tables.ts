// What is told in tables: summaries, the comparison, configurations and where the results are from.
import { type Comparison, type Difference, type Report, type Run, type Setting, type Summary } from "./data";
import { el, list, replace, section, table } from "./elements";
import { count, fixed, nameOf, proportion, significant } from "./numbers";
import { explained } from "./words";

const name = (run: Run): string => run.name;

export function summarySection(runs: Run[]): HTMLElement {
  const cells = (tell: (summary: Summary) => string): string[] =>
    runs.map((run) => (run.summary ? tell(run.summary) : "–"));
  const rows: [string, (summary: Summary) => string][] = [
    ["experiment, seed", (s) => `${s.name}, ${s.seed}`],
    ["trials", (s) => count(s.trials.count)],
    ["right, wrong, undecided", (s) => `${s.trials.right}, ${s.trials.wrong}, ${s.trials.undecided}`],
    ["failed", (s) => count(s.trials.failed ?? 0)],
    ["success", (s) => proportion(s.success_rate)],
    ["wrong", (s) => proportion(s.false_rate)],
    ["steps to localize, median", (s) => (s.trials.right > 0 ? fixed(s.steps_to_localize.median, 1) : "–")],
    ["distance to localize, median", (s) => (s.trials.right > 0 ? `${fixed(s.distance_to_localize_m.median, 2)} m` : "–")],
    [
      "error when localized, median",
      (s) =>
        s.trials.right > 0
          ? `${fixed(s.translation_error_m.median, 3)} m, ${fixed(s.rotation_error_deg.median, 2)}°`
          : "–",
    ],
    ["wall time of a step, median (95 %)", (s) => `${fixed(s.step_ms.median, 1)} ms (${fixed(s.step_ms.p95, 1)} ms)`],
    ["matching, median", (s) => `${fixed(s.stage_ms.match.median, 1)} ms`],
    ["points of the map", (s) => count(s.map.points)],
    ["memory, largest", (s) => `${fixed(s.peak_rss_mb, 0)} MiB`],
  ];
  const interrupted = runs.filter((run) => run.summary && !run.summary.complete).map(name);
  return section(
    "summary",
    "Summary",
    interrupted.length > 0 &&
      el("p", { class: "warning" }, `Interrupted, so that trials are missing: ${interrupted.join(", ")}`),
    table(["", ...runs.map(name)], rows.map(([title, tell]) => [explained(el("span", {}, title)), ...cells(tell)])),
    el("p", { class: "note" }, "Intervals are those after Wilson, 95 %."),
  );
}

export function comparisonSection(report: Report): HTMLElement | null {
  const { comparison, comparison_refused: refused } = report;
  if (refused !== undefined) return section("comparison", "Comparison", el("p", { class: "warning" }, refused));
  if (!comparison) return null;
  const ofPairs = comparison.pairs.flatMap(({ variant, warnings: own }) => own.map((text) => `${variant}: ${text}`));
  const warnings = [...comparison.warnings, ...ofPairs];
  return section(
    "comparison",
    `Comparison with ${comparison.baseline}`,
    list(comparison.pairs.map((pair) => pair.conclusion)),
    list(warnings, "warning"),
    table(
      ["variant", "measure", explained(el("span", {}, comparison.baseline), "of the baseline"), "variant's", "difference (95 %)", "test", "p", "p after Holm"],
      comparisonRows(comparison),
    ),
    el(
      "p",
      { class: "note" },
      `Over the ${comparison.starts} starts that all methods share, at ${comparison.places} places; differences are variant less baseline. ` +
        `Bold: significant, p after Holm below ${comparison.significance}.`,
    ),
  );
}

function comparisonRows({ pairs }: Comparison): (Node | string)[][] {
  const difference = (d: Difference, unit = ""): string =>
    `${significant(d.value)}${unit} (${significant(d.low)} to ${significant(d.high)})`;
  const p = (value: number, isSignificant: boolean): Node | string => {
    const text = value < 0.001 ? "< 0.001" : fixed(value, 3);
    return isSignificant ? el("strong", {}, text) : text;
  };
  return pairs.flatMap((pair) => [
    ...pair.outcomes.map((o) => [
      pair.variant,
      o.outcome,
      count(o.both + o.only_baseline),
      count(o.both + o.only_variant),
      difference(o.difference_points, " points"),
      o.test.replaceAll("_", " "),
      p(o.p, false),
      p(o.p_holm, o.significant),
    ]),
    ...pair.measures.map((m) => [
      pair.variant,
      nameOf(m.measure),
      significant(m.baseline_median),
      significant(m.variant_median),
      difference(m.mean_difference),
      m.test.replaceAll("_", " "),
      p(m.p, false),
      p(m.p_holm, m.significant),
    ]),
  ]);
}

/** Values by path, a column for each run; what differs between runs comes first and is marked. */
export function configurationSection(runs: Run[]): HTMLElement {
  const paths = [...new Set(runs.flatMap((run) => Object.keys(run.settings)))].sort();
  const identity = (setting: Setting | undefined): string | undefined => setting && (setting.identity ?? setting.text);
  const differs = (path: string): boolean =>
    runs.some((run) => identity(run.settings[path]) !== identity(runs[0].settings[path]));
  const different = paths.filter(differs);
  const same = paths.filter((path) => !differs(path));
  const filter = el("input", { type: "search", placeholder: "part of a name", "aria-label": "Show settings with this in their name" });
  const onlyDifferent = el("input", { type: "checkbox", checked: different.length > 0 });
  const target = el("div", {});
  const fill = (): void => {
    const chosen = (onlyDifferent.checked ? different : [...different, ...same]).filter((path) =>
      path.toLowerCase().includes(filter.value.toLowerCase()),
    );
    const cell = (run: Run, path: string): Node | string => {
      const text = run.settings[path]?.text ?? "–";
      return differs(path) ? el("mark", {}, text) : text;
    };
    replace(target, table(["", ...runs.map(name)], chosen.map((path) => [path, ...runs.map((run) => cell(run, path))])));
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
  const told = (value: unknown): Node | string => {
    if (value === undefined) return "–";
    if (typeof value !== "object" || value === null) return String(value);
    const entries = Array.isArray(value) ? value.map(String) : Object.entries(value).map(([k, v]) => `${k}: ${typeof v === "object" ? JSON.stringify(v) : String(v)}`);
    return entries.length === 0 ? "none" : el("ul", { class: "files" }, ...entries.map((entry) => el("li", {}, entry)));
  };
  return section(
    "provenance",
    "Provenance",
    table(
      ["", ...runs.map(name)],
      [
        ["folder", ...runs.map((run) => run.folder)],
        ...keys.map((key) => [key.replaceAll("_", " "), ...runs.map((run) => told(run.provenance?.[key]))]),
      ],
    ),
    el("p", { class: "note" }, `Made by ${report.generator}.`),
  );
}
