// The starts that a method loses and another one wins, and how to find out why.
import { linkTo, placeOf, type Asked, type Board, type BoardSuite, type Entry, type Result } from "./board_data";
import { DataTable, type Column } from "./data_table";
import { el, replace, section } from "./elements";
import { count, fixed } from "./numbers";

const names: Record<string, string> = { r: "right", w: "wrong", u: "undecided", d: "declared", f: "failed" };
const worstFirst = "wfdu";
const mostRows = 50;

interface Lost {
  own: Result;
  other: Result;
  winner: string;
  /** Its number among the case's, and where both results have it. */
  start: number;
  at: number;
  otherAt: number;
}

/** Those of `own` that are not right, and right for the first of `others` that has it so; wrong ones first. */
export function lostStarts(own: Entry, others: Entry[], oneCase = ""): Lost[] {
  const lost = own.results.flatMap((result) => {
    if (oneCase !== "" && result.case !== oneCase) return [];
    const rivals = others.flatMap(({ method, results }) => results.filter((other) => other.case === result.case && other.seed === result.seed).map((other) => ({ method, other })));
    return [...result.outcome].flatMap((outcome, at): Lost[] => {
      const start = result.numbers?.[at] ?? at;
      const winner = outcome === "r" ? undefined : rivals.find(({ other }) => other.outcome[placeOf(other, start)] === "r");
      return winner ? [{ own: result, other: winner.other, winner: winner.method, start, at, otherAt: placeOf(winner.other, start) }] : [];
    });
  });
  const rank = ({ own: its, at }: Lost): number => worstFirst.indexOf(its.outcome[at]);
  return lost.sort((a, b) => rank(a) - rank(b));
}

/** A word for a shell. */
const quoted = (word: string): string => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", `'\\''`)}'`);

export function explainCommands(suite: string, method: string, { own, start }: Lost): string {
  const run = `${method}_${own.case}_seed-${own.seed}`;
  // Not where results of a share may be, whose runs have the same names.
  const out = `results/explain/${suite}/${method}`;
  return (
    `glocal run --suite ${quoted(suite)} --method ${quoted(method)} --only ${quoted(run)} --out ${quoted(out)}\n` +
    `glocal explain ${quoted(`${out}/${run}`)} --trial ${start}`
  );
}

function error(result: Result, start: number): string {
  const [cm, deg] = [result.cm[start], result.deg[start]];
  if (cm === null) return "–";
  return `${cm < 100 ? `${fixed(cm, 1)} cm` : `${fixed(cm / 100, 1)} m`}, ${fixed(deg, 2)}°`;
}

const outcome = (result: Result, start: number): HTMLElement => {
  const name = names[result.outcome[start]] ?? "";
  return el("span", { class: `outcome ${name}` }, name);
};

function columnsFor(choose: (lost: Lost) => void, hasSeeds: boolean): Column<Lost>[] {
  const least = (by: (lost: Lost) => number | string | null): Column<Lost>["order"] => ({ by, best: "least" });
  const seed: Column<Lost> = { name: "seed", cell: ({ own }) => String(own.seed), order: least(({ own }) => own.seed) };
  return [
    {
      name: "start",
      meaning: "Number of the start, from 0 on in the order of the drive. The button tells how to have it explained.",
      cell: (lost) => el("button", { type: "button", "data-start": lost.start, click: () => choose(lost) }, `${lost.own.case} ${lost.start}`),
      order: least(({ own, start }) => `${own.case} ${start}`),
    },
    ...(hasSeeds ? [seed] : []),
    { name: "outcome", cell: ({ own, at }) => outcome(own, at), order: least(({ own, at }) => worstFirst.indexOf(own.outcome[at])) },
    { name: "steps", word: "steps of a trial", cell: ({ own, at }) => count(own.steps[at]), order: least(({ own, at }) => own.steps[at]) },
    { name: "error", cell: ({ own, at }) => error(own, at), order: least(({ own, at }) => own.cm[at]) },
    { name: "right by", meaning: "The best method that is right there.", cell: ({ winner }) => winner, order: least(({ winner }) => winner) },
    { name: "its steps", meaning: "Steps up to its declaration.", cell: ({ other, otherAt }) => count(other.steps[otherAt]), order: least(({ other, otherAt }) => other.steps[otherAt]) },
    { name: "its error", meaning: "How far the pose that it declares is from the reference pose, and turned against it.", cell: ({ other, otherAt }) => error(other, otherAt), order: least(({ other, otherAt }) => other.cm[otherAt]) },
  ];
}

/** The part of the page that a link leads to. */
export class LostStarts {
  private readonly body = el("div", {}, el("p", { class: "note" }, "A click on numbers of a method lists its starts here."));
  readonly element = section("lost", "Lost starts", this.body);

  constructor(private readonly board: Board) {}

  show(asked: Asked): void {
    const suite = this.board.suites.find((each) => each.suite === asked.suite);
    const own = suite?.entries.find(({ method }) => method === asked.method);
    if (!suite || !own) return replace(this.body, el("p", { class: "warning" }, `There are no results of ${asked.method} on ${asked.suite}.`));
    const others = suite.entries.filter((entry) => entry !== own && (asked.by === "" || entry.method === asked.by));
    const lost = lostStarts(own, others, asked.case);
    const commands = el("pre", { class: "commands", tabindex: 0, "aria-live": "polite" });
    const choose = (chosen: Lost): void => {
      replace(commands, own.imported ? `The poses of ${own.method} are of another program, which would have to explain them.` : explainCommands(suite.suite, own.method, chosen));
    };
    const table = new DataTable(columnsFor(choose, new Set(own.results.map(({ seed }) => seed)).size > 1), { keys: 2, most: mostRows, what: "starts" });
    replace(
      this.body,
      el("div", { class: "controls" }, this.picker("method", asked, suite.entries.map(({ method }) => method)), this.picker("case", asked, suite.cases), this.picker("by", asked, suite.entries.filter((entry) => entry !== own).map(({ method }) => method))),
      el("p", { class: "told" }, told(suite, own, asked, lost)),
      lost.length > 0 && commands,
      lost.length > 0 && table.element,
    );
    table.setRows(lost);
    if (lost.length > 0) choose(lost[0]);
  }

  private picker(what: "method" | "case" | "by", asked: Asked, all: string[]): HTMLElement {
    const select = el("select", { "data-asked": what, change: () => (location.hash = linkTo({ ...asked, [what]: select.value })) });
    if (what !== "method") select.append(el("option", { value: "" }, what === "case" ? "all" : "any other"));
    select.append(...all.map((name) => el("option", { value: name, selected: name === asked[what] }, name)));
    return el("label", {}, what === "by" ? "right by " : `${what} `, select);
  }
}

function told({ suite, entries }: BoardSuite, own: Entry, asked: Asked, lost: Lost[]): string {
  if (entries.length < 2) return `No other method has results on ${suite}.`;
  const by = asked.by === "" ? "another method" : asked.by;
  const where = asked.case === "" ? suite : `${asked.case} of ${suite}`;
  return `${count(lost.length)} ${lost.length === 1 ? "start" : "starts"} on ${where} that ${own.method} does not get right and ${by} does; wrong ones first.`;
}
