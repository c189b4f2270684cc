// What a sweep has taught: its best settings, what each parameter does, and two of them in a map.
import { inkOn, ratingColour } from "./colours";
import type { ParameterEffect, Proportion, Report, Sweep, SweepMap } from "./data";
import { DataTable, type Column } from "./data_table";
import { colourBar, el, list, section } from "./elements";
import { csvButtonOf, saveMenu } from "./export";
import { count, fixed, percent, proportion } from "./numbers";
import { parallelCoordinates } from "./parallel";
import { effectSvg, heatSvg } from "./sweep_svg";

const mostSettings = 20;

export function sweepSection({ sweep }: Report): HTMLElement | null {
  if (!sweep) return null;
  return section(
    "sweep",
    "Sweep",
    list(sweep.warnings, "warning"),
    saysMore(sweep) && settingsTable(sweep),
    sweep.effects.length > 0 && el("div", { class: "effects" }, ...sweep.effects.map(effectChart)),
    el("div", { class: "maps" }, sweep.map && heatMap(sweep.map), parallelCoordinates(sweep)),
    el(
      "p",
      { class: "note" },
      "Score: right less wrong trials, in points of all; settings are ranked by it, then by fewer steps. Intervals are " +
        "95 %, and take trials at one place for alike. What a parameter does is the mean over all else that varies.",
    ),
  );
}

type Setting = Sweep["settings"][0];

/** Than the page's first table: parameters, or what judges a setting. */
function saysMore({ effects, judge_on: judged }: Sweep): boolean {
  return judged.length > 0 || effects.length > 1 || effects.some(({ path }) => path !== "method");
}

function settingsTable(sweep: Sweep): HTMLElement {
  const by = (cases: string[]): string => (cases.length > 0 ? ` by ${cases.join(", ")}` : "");
  const counted = (outcome: "right" | "wrong" | "undecided" | "trials", best: "least" | "most"): Column<Setting> => ({
    name: outcome,
    cell: ({ chosen }) => count(chosen[outcome]),
    order: { by: ({ chosen }) => chosen[outcome], best },
  });
  const columns: Column<Setting>[] = [
    { name: "setting", cell: ({ setting, complete }) => `${setting || "the experiment"}${complete ? "" : " (incomplete)"}`, order: { by: ({ setting }) => setting, best: "least" } },
    counted("right", "most"),
    counted("wrong", "least"),
    { name: "steps", cell: ({ chosen }) => fixed(chosen.median_steps, 1), order: { by: ({ chosen }) => chosen.median_steps, best: "least" } },
    { name: "score", word: "score of a setting", cell: ({ chosen }) => fixed(100 * chosen.score, 1), order: { by: ({ chosen }) => chosen.score, best: "most" } },
    ...sweep.effects.map(({ label, path }): Column<Setting> => ({
      name: label,
      meaning: `The setting's value of ${path}.`,
      cell: ({ values }) => values[path] ?? "–",
      order: { by: ({ values }) => numberOr(values[path]), best: "least" },
    })),
    { name: `success${by(sweep.choose_on)}`, word: "success", cell: ({ chosen }) => proportion(chosen.success_rate), order: { by: ({ chosen }) => chosen.success_rate.value, best: "most" } },
    counted("undecided", "least"),
    counted("trials", "most"),
  ];
  const judged: Column<Setting> = {
    name: `success judged${by(sweep.judge_on)}`,
    word: "success judged",
    cell: ({ judged: its }) => (its ? proportion(its.success_rate) : "–"),
    order: { by: ({ judged: its }) => its?.success_rate.value, best: "most" },
  };
  if (sweep.judge_on.length > 0) columns.splice(4, 0, judged);
  const table = new DataTable(columns, { keys: 4, most: mostSettings, what: "settings" });
  table.setRows(sweep.settings);
  return table.element;
}

/** Numbers are sorted as such. */
function numberOr(text: string | undefined): number | string | undefined {
  return text !== undefined && text !== "" && Number.isFinite(Number(text)) ? Number(text) : text;
}

/** Where a share lies on an axis from 0 to 100 %. */
const along = (share: number): string => `${(100 * share).toFixed(2)}%`;

function intervalAndDot(p: Proportion): HTMLElement[] {
  return [
    el("i", { class: "interval", style: `left: ${along(p.low)}; width: ${along(p.high - p.low)}` }),
    el("i", { class: "dot", style: `left: ${along(p.value)}` }),
  ];
}

/** Shares are of 1. */
function effectRows({ label, levels }: ParameterEffect): string[][] {
  const head = [label, "settings", "trials", "right", "low", "high"];
  const rows = levels.map(({ label, settings, trials, success_rate: { value, low, high } }) => [label, ...[settings, trials, value, low, high].map(String)]);
  return [head, ...rows];
}

function effectChart(effect: ParameterEffect): HTMLElement {
  const correlation = effect.spearman === undefined ? "" : `; rank correlation ${fixed(effect.spearman, 2)}`;
  const told = `: ${fixed(100 * effect.range, 1)} points${effect.quarters ? ", by quarters of its values" : ""}${correlation}`;
  const what = (): string => `effect of ${effect.label}`;
  const ticks = [0, 0.25, 0.5, 0.75, 1];
  return el(
    "figure",
    { class: "effect" },
    el(
      "figcaption",
      {},
      el("strong", { title: effect.path }, effect.label),
      told,
      saveMenu(what, () => effectSvg(effect, `${effect.label}${told}`)),
      csvButtonOf(what, () => effectRows(effect)),
    ),
    ...effect.levels.flatMap((level) => [
      el("span", { class: "level", title: `${level.settings} settings, ${level.trials} trials` }, level.label),
      el("span", { class: "track" }, ...(level.trials > 0 ? intervalAndDot(level.success_rate) : [])),
      el("span", { class: "share" }, level.trials > 0 ? percent(level.success_rate.value) : "–"),
    ]),
    el("span", { class: "level" }, "right trials"),
    el("span", { class: "axis" }, ...ticks.map((tick) => el("i", { style: `left: ${along(tick)}` }, `${100 * tick} %`))),
  );
}

/** Percent of right trials, and nothing where there is no such setting. */
function heatRows({ rows, columns, cells }: SweepMap): string[][] {
  const number = ({ trials, success_rate: { value } }: SweepMap["cells"][0][0]): string => (trials > 0 ? String(100 * value) : "");
  return [[`${rows.label} \\ ${columns.label}`, ...columns.levels], ...rows.levels.map((level, r) => [level, ...cells[r].map(number)])];
}

function heatMap(map: SweepMap): HTMLElement {
  const cell = (r: number, c: number): HTMLElement => {
    const { settings, trials, success_rate: success } = map.cells[r][c];
    if (trials === 0) return el("td", { class: "empty", title: "no such setting" }, "–");
    return el(
      "td",
      {
        style: `background: ${ratingColour(success.value)}; color: ${inkOn(success.value)}`,
        title: `${proportion(success)}; ${settings} settings, ${trials} trials`,
      },
      fixed(100 * success.value, 0),
    );
  };
  const title = `Right trials, %, by ${map.rows.label} and ${map.columns.label}`;
  const what = (): string => `${map.rows.label} and ${map.columns.label}`;
  return el(
    "figure",
    { class: "heat" },
    el("figcaption", {}, title, saveMenu(what, () => heatSvg(map, title)), csvButtonOf(what, () => heatRows(map))),
    el(
      "div",
      { class: "scroll", tabindex: 0 },
      el(
        "table",
        {},
        el(
          "thead",
          {},
          el("tr", {}, el("th", {}), el("th", { colspan: map.columns.levels.length, class: "name", title: map.columns.path }, map.columns.label)),
          el("tr", {}, el("th", { class: "name", title: map.rows.path }, map.rows.label), ...map.columns.levels.map((text) => el("th", { scope: "col", title: `${map.columns.path}: ${text}` }, text))),
        ),
        el(
          "tbody",
          {},
          ...map.rows.levels.map((text, r) => el("tr", {}, el("th", { scope: "row", title: `${map.rows.path}: ${text}` }, text), ...map.columns.levels.map((_, c) => cell(r, c)))),
        ),
      ),
    ),
    el("p", { class: "legend" }, "0 % ", colourBar(ratingColour, 11), " 100 % right"),
  );
}
