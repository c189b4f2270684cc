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
  cpu: string;
  /** Poses of another program. */
  imported: boolean;
  all: Counts;
  /** In the order of the suite's. */
  cases: Counts[];
  results: Result[];
  renewals: Renewal[];
  /** CPU time of a step. */
  step_ms?: number;
}

export interface BoardSuite {
  suite: string;
  cases: string[];
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

export const scoreOf = ({ right, wrong }: Counts): number => right - wrong;

/** Whose starts are asked for; of one case, or of all, and won by one method, or by any. */
export interface Asked {
  suite: string;
  method: string;
  case: string;
  by: string;
}

export function linkTo({ suite, method, case: one = "", by = "" }: Partial<Asked>): string {
  return `#${new URLSearchParams({ suite: suite ?? "", method: method ?? "", case: one, by })}`;
}

export function askedIn(address: string): Asked | null {
  const words = new URLSearchParams(address.replace(/^#/, ""));
  const word = (name: string): string => words.get(name) ?? "";
  return words.has("suite") ? { suite: word("suite"), method: word("method"), case: word("case"), by: word("by") } : null;
}
