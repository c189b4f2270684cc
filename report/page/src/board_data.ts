// What the program puts in the page of the leaderboard.
import type { Proportion } from "./data";

export interface Counts {
  starts: number;
  wrong: number;
  right: number;
  undecided: number;
  wrong_rate: Proportion;
  right_rate: Proportion;
  undecided_rate: Proportion;
}

/** Of a case and seed, as the entry's file has them: a letter, or a number, for each start. */
export interface Result {
  case: string;
  seed: number;
  /** Which starts of the case, where the entry has a share of them; else all. */
  numbers?: number[];
  outcome: string;
  steps: number[];
  cm: (number | null)[];
  deg: (number | null)[];
}

/** What an entry came to when it was written; p of the step from the one before. */
export interface Renewal extends Counts {
  date: string;
  revision: string;
  p_right?: number;
  p_wrong?: number;
  significant?: boolean;
}

export interface Entry {
  method: string;
  /** With the share of the suite that it has, if that is not all. */
  label: string;
  cpu: string;
  /** Poses of another program. */
  imported: boolean;
  all: Counts;
  /** In the order of the suite's. */
  cases: Counts[];
  results: Result[];
  /** Of each kind of disturbance of the suite, from level 1 on: right starts, as a share of those without it. */
  kept: (number | null)[][];
  renewals: Renewal[];
  /** CPU time of a step. */
  step_ms?: number;
}

export interface BoardSuite {
  suite: string;
  cases: string[];
  disturbances: string[];
  /** The best first. */
  entries: Entry[];
}

export interface Board {
  format: number;
  generator: string;
  significance: number;
  /** All names, the best over all suites first. */
  methods: string[];
  suites: BoardSuite[];
}

export const scoreOf = ({ starts, right, wrong }: Counts): number => (right - wrong) / Math.max(starts, 1);

/** Where a result has a start of the case; nowhere if it is not among its share. */
export const placeOf = ({ numbers }: Result, start: number): number => (numbers ? numbers.indexOf(start) : start);

/** Whose starts are asked for; of one case, or of all, and won by one method, or by any. */
export interface Asked {
  suite: string;
  method: string;
  case: string;
  by: string;
}

export function linkTo(asked: Partial<Asked>): string {
  return `#${new URLSearchParams({ suite: "", method: "", case: "", by: "", ...asked })}`;
}

export function askedIn(address: string): Asked | null {
  const words = new URLSearchParams(address.replace(/^#/, ""));
  const word = (name: string): string => words.get(name) ?? "";
  return words.has("suite") ? { suite: word("suite"), method: word("method"), case: word("case"), by: word("by") } : null;
}
