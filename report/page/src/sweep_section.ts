// What a sweep has taught: its best settings, what each parameter does, and two of them in a map.
import { ratingColour } from "./colours";
import type { ParameterEffect, Proportion, Report, SettingOutcome, Sweep, SweepMap } from "./data";
import { el, list, section, table } from "./elements";
import { csvButtonOf, saveMenu } from "./export";
import { count, fixed, percent, proportion } from "./numbers";
import { parallelCoordinates } from "./parallel";
import { effectSvg, heatSvg } from "./sweep_svg";
import { explained, withMeaning } from "./words";

const mostSettings = 20;

export function sweepSection({ sweep }: Report): HTMLElement | null {
  if (!sweep) return null;
  return section(
    "sweep",
    "Sweep",
    list(sweep.warnings, "warning"),
    settingsTable(sweep),
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

function settingsTable(sweep: Sweep): HTMLElement {
  const isJudged = sweep.judge_on.length > 0;
  const cells = (o: SettingOutcome): string[] => [
    count(o.trials),
    `${o.right}, ${o.wrong}, ${o.undecided}`,
    proportion(o.success_rate),
    fixed(100 * o.score, 1),
    fixed(o.median_steps, 1),
  ];
  const by = (cases: string[]): string => (cases.length > 0 ? ` by ${cases.join(", ")}` : "");
  const shown = sweep.settings.slice(0, mostSettings);
  return el(
    "div",
    {},
    table(
      [
        "setting",
        "trials",
        "right, wrong, undecided",
        explained(el("span", {}, `success${by(sweep.choose_on)}`), "success"),
        explained(el("span", {}, "score"), "score of a setting"),
        "steps, median",
        ...(isJudged ? [explained(el("span", {}, `success judged${by(sweep.judge_on)}`), "success judged")] : []),
        ...sweep.effects.map(({ label, path }) => withMeaning(el("span", {}, label), `The setting's value of ${path}.`)),
      ],
      shown.map((setting) => [
        `${setting.setting || "the experiment"}${setting.complete ? "" : " (incomplete)"}`,
        ...cells(setting.chosen),
        ...(isJudged ? [setting.judged ? proportion(setting.judged.success_rate) : "–"] : []),
        ...sweep.effects.map((effect) => setting.values[effect.path] ?? "–"),
      ]),
    ),
    sweep.settings.length > shown.length &&
      el("p", { class: "note" }, `The best ${shown.length} of ${sweep.settings.length} settings.`),
  );
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

/** Black or white, whichever is read more easily on the colour of a share: viridis is dark below the middle. */
const inkOn = (share: number): string => (share > 0.43 ? "#000000" : "#ffffff");

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
  const stops = Array.from({ length: 11 }, (_, i) => ratingColour(i / 10)).join(", ");
  const title = `Right trials, %, by ${map.rows.label} and ${map.columns.label}`;
  const what = (): string => `${map.rows.label} and ${map.columns.label}`;
  return el(
    "figure",
    { class: "heat" },
    el("figcaption", {}, title, saveMenu(what, () => heatSvg(map, title, inkOn)), csvButtonOf(what, () => heatRows(map))),
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
    el("p", { class: "legend" }, "0 % ", el("span", { class: "bar", style: `background: linear-gradient(to right, ${stops})` }), " 100 % right"),
  );
}
