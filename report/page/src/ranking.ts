// What came out of several runs, on top of the page: the best first, to be searched, filtered and sorted.
import { answerOf, axesOf, byAnswer, casesAxis, groupsOf, isJudged, levelsOf, scoreOf, searched, type Answer, type Axis, type Level } from "./answers";
import type { Run } from "./data";
import { DataTable, type Column } from "./data_table";
import { el, replace } from "./elements";
import { count, fixed, percent, significant } from "./numbers";
import type { Store } from "./store";

const mostRows = 30;

const levelNames: Record<Level, string> = { setting: "settings", case: "settings, by case", run: "runs" };

/** Right, wrong and all others, as a bar of that length. */
function bar(answer: Answer): HTMLElement {
  const part = (outcome: "right" | "wrong" | "declared" | "failed"): HTMLElement =>
    el("i", { class: outcome, style: `width: ${(100 * answer[outcome]) / Math.max(1, answer.trials.length)}%` });
  return el("span", { class: "outcomes", "aria-hidden": "true" }, part("right"), part("declared"), el("i", { class: "rest" }), part("failed"), part("wrong"));
}

const least = (by: (answer: Answer) => number | null): Column<Answer>["order"] => ({ by, best: "least" });
const most = (by: (answer: Answer) => number | null): Column<Answer>["order"] => ({ by, best: "most" });
const counted = (outcome: "right" | "wrong" | "undecided" | "declared" | "failed", order: Column<Answer>["order"]): Column<Answer> => ({
  name: outcome,
  cell: (answer) => count(answer[outcome]),
  order,
  // What did not happen needs no colour.
  kind: (answer) => `number ${answer[outcome] > 0 ? outcome : "none"}`,
});
const measured = (name: string, unit: string, by: (answer: Answer) => number | null, tell: (value: number) => string, word = name): Column<Answer> => ({
  name: unit ? `${name}, ${unit}` : name,
  word,
  cell: (answer) => {
    const value = by(answer);
    return value === null ? "–" : tell(value);
  },
  order: least(by),
  kind: () => "number",
});

function columnsOf(store: Store, hasDeclared: boolean, hasFailed: boolean): Column<Answer>[] {
  const name: Column<Answer> = {
    name: "name",
    word: "run or setting",
    cell: (answer) => el("span", { class: "named" }, el("button", { type: "button", "data-run": store.report.runs.indexOf(answer.runs[0]), "aria-pressed": String(answer.runs.includes(store.run)), click: () => store.chooseRun(store.report.runs.indexOf(answer.runs[0])) }, answer.isWhole ? answer.name : `${answer.name} (incomplete)`), bar(answer)),
    order: { by: ({ name: its }) => its, best: "least" },
  };
  return [
    name,
    counted("right", most(({ right, trials }) => right / trials.length)),
    counted("wrong", least(({ wrong, trials }) => wrong / trials.length)),
    measured("steps", "", ({ steps }) => steps, (v) => fixed(v, 1).replace(".0", "")),
    counted("undecided", least(({ undecided, trials }) => undecided / trials.length)),
    ...(hasDeclared ? [counted("declared", most(({ declared, trials }) => declared / trials.length))] : []),
    ...(hasFailed ? [counted("failed", least(({ failed, trials }) => failed / trials.length))] : []),
    { name: "score", word: "score of a setting", cell: (answer) => (answer.trials.length > 0 ? percent(scoreOf(answer)) : "–"), order: most(scoreOf), kind: () => "number" },
    { name: "trials", cell: ({ trials }) => count(trials.length), order: most(({ trials }) => trials.length), kind: () => "number" },
    measured("time", "ms", ({ step_ms: ms }) => ms, (v) => significant(v, 2), "wall time of a step"),
    measured("error", "m", ({ error_m: m }) => m, (v) => fixed(v, 3), "error at declaration"),
    measured("angle", "°", ({ angle_deg: deg }) => deg, (v) => fixed(v, 2), "angle error"),
    measured("way", "m", ({ way_m: m }) => m, (v) => fixed(v, 2)),
    measured("memory", "MiB", ({ memory_mb: mb }) => mb, (v) => fixed(v, 0), "memory, largest"),
  ];
}

/** The runs of the report, as rows of what they are of. */
export class Ranking {
  readonly element: HTMLElement;
  private readonly table: DataTable<Answer>;
  private readonly search = el("input", { type: "search", placeholder: "name or setting", "aria-label": "Show what has these words in its name or its settings", input: () => this.fill() });
  private readonly told = el("output", { class: "note" });
  private readonly chosen = new Map<Axis, string>();
  private level: Level;

  constructor(private readonly store: Store) {
    const { runs } = store.report;
    const levels = levelsOf(runs);
    const axes = axesOf(runs);
    // Nothing is chosen by what judges it.
    const cases = axes.find(({ name }) => name === casesAxis);
    const chosenBy = runs.find((run) => !isJudged(run));
    if (cases && chosenBy) this.chosen.set(cases, cases.valueOf(chosenBy));
    this.level = levels[0];
    const shown = axes.filter(({ isParameter }) => !isParameter);
    const folded = axes.filter(({ isParameter }) => isParameter);
    const has = (outcome: "declared" | "failed"): boolean => runs.some((run) => run.trials.some((trial) => trial.outcome === outcome));
    this.table = new DataTable(columnsOf(store, has("declared"), has("failed")), {
      keys: 4,
      most: mostRows,
      what: "settings and runs",
      className: "overview",
    });
    const interrupted = runs.filter(({ summary }) => summary && !summary.complete).map((run) => run.name);
    this.element = el(
      "section",
      { id: "figures", class: "figures", "aria-label": "What came out" },
      interrupted.length > 0 && el("p", { class: "warning" }, `Interrupted, so that trials are missing: ${interrupted.join(", ")}`),
      el(
        "div",
        { class: "controls" },
        levels.length > 1 && this.levelPicker(levels),
        ...shown.map((axis) => this.axisPicker(axis)),
        this.search,
        folded.length > 0 && el("details", {}, el("summary", {}, "by parameters"), el("div", { class: "controls" }, ...folded.map((axis) => this.axisPicker(axis)))),
        this.told,
      ),
      this.table.element,
      el("p", { class: "note" }, "The best first: by right less wrong trials, as a share of all, then by fewer steps; last what lacks a case, a seed or trials. Steps, way and errors: medians of right trials. Time: median of steps."),
    );
    store.subscribe((change) => change.run && this.mark());
    this.fill();
  }

  private levelPicker(levels: Level[]): HTMLElement {
    const select = el("select", { id: "level", change: () => { this.level = select.value as Level; this.fill(); } });
    select.append(...levels.map((level) => el("option", { value: level }, levelNames[level])));
    return el("label", {}, "rows ", select);
  }

  private axisPicker(axis: Axis): HTMLElement {
    const select = el("select", {
      "data-axis": axis.name,
      change: () => {
        if (select.value === "") this.chosen.delete(axis);
        else this.chosen.set(axis, axis.values[Number(select.value)]);
        this.fill();
      },
    });
    const chosen = this.chosen.get(axis);
    select.append(el("option", { value: "" }, "all"), ...axis.values.map((value, i) => el("option", { value: i, selected: value === chosen }, value || "none")));
    return el("label", { title: axis.name }, `${axis.name.slice(axis.name.lastIndexOf(".") + 1)} `, select);
  }

  private filtered(): Run[] {
    const { runs } = this.store.report;
    const chosen = runs.filter((run) => [...this.chosen].every(([axis, value]) => axis.valueOf(run) === value));
    return searched(chosen, this.search.value);
  }

  private fill(): void {
    const { runs } = this.store.report;
    const found = this.filtered();
    this.table.setRows(groupsOf(found, this.level).map(answerOf).sort(byAnswer));
    replace(this.told, found.length < runs.length && `${count(found.length)} of ${count(runs.length)} runs`);
    if (found.length !== this.store.shown.length || found.some((run, i) => run !== this.store.shown[i])) this.store.showRuns(found);
  }

  /** The row that holds the chosen run. */
  private mark(): void {
    for (const [row, { runs }] of this.table.shown) row.querySelector("[data-run]")?.setAttribute("aria-pressed", String(runs.includes(this.store.run)));
  }
}
