// What is shown at the moment. Whoever shows something of it listens for changes.
import type { Chunks } from "./chunks";
import { firstLocalized, type GlobalMap, type Report, type Run, type Steps, type Trial } from "./data";

/** Which pose the local map is laid under: a cluster by its rank, what the verdict rule believes, or the truth. */
export type Hypothesis = number | "estimate" | "reference";

export interface Selection {
  run: number;
  /** Index into the run's trials. */
  trial: number;
  /** Index into the trial's steps. */
  step: number;
  hypothesis: Hypothesis;
}

export interface Change {
  /** Other data, or another run. */
  run: boolean;
  trial: boolean;
  step: boolean;
  hypothesis: boolean;
  /** Other runs are looked at together. */
  shown: boolean;
}

type Listener = (change: Change) => void;

/** What is to be shown; without a step that which the trial opens at. */
type Wanted = Omit<Selection, "step"> & { step: number | undefined };

const nothing: Change = { run: false, trial: false, step: false, hypothesis: false, shown: false };
const everything: Change = { run: true, trial: true, step: true, hypothesis: true, shown: true };

export class Store {
  private selection: Selection = { run: 0, trial: 0, step: 0, hypothesis: "estimate" };
  /** The same, but while the steps of a trial are loaded. */
  private wanted: Wanted = this.selection;
  private listeners: Listener[] = [];
  private runsShown: readonly Run[];
  private loads = 0;
  private lastFault: string | null = null;

  constructor(
    private current: Report,
    private readonly chunks: Chunks,
  ) {
    this.runsShown = current.runs;
    if (current.live) this.selection = { ...this.selection, ...this.newest() };
    this.wanted = { ...this.selection, step: current.live ? this.selection.step : undefined };
  }

  /** Loads what the page opens at. */
  async open(): Promise<void> {
    const { trial } = this;
    if (trial) await this.load([trial]);
    this.select(this.wanted);
  }

  get report(): Report {
    return this.current;
  }
  get selected(): Readonly<Selection> {
    return this.selection;
  }
  get run(): Run {
    return this.current.runs[this.selection.run];
  }
  /** Undefined where the results hold none. */
  get map(): GlobalMap | undefined {
    const { map } = this.run;
    return map === undefined ? undefined : this.current.maps[map];
  }
  get trial(): Trial | undefined {
    return this.run.trials[this.selection.trial];
  }
  get steps(): Steps | undefined {
    return this.trial?.columns;
  }
  /** Those that are looked at together. */
  get shown(): readonly Run[] {
    return this.runsShown;
  }
  /** Why steps are not there that should be. */
  get fault(): string | null {
    return this.lastFault;
  }
  get lastStep(): number {
    return lastOf(this.steps);
  }

  subscribe(listener: Listener): void {
    this.listeners.push(listener);
  }

  showRuns(runs: readonly Run[]): void {
    this.runsShown = runs;
    this.tell({ ...nothing, shown: true });
  }

  /** False if something else was wanted before the steps were loaded. */
  async show(wanted: Wanted): Promise<boolean> {
    this.wanted = wanted;
    const trial = this.current.runs[wanted.run].trials[wanted.trial];
    if (trial?.chunk !== undefined) await this.load([trial]);
    if (wanted !== this.wanted) return false;
    this.select(wanted);
    return true;
  }

  /** Has the steps of these trials loaded; tells of those that cannot be. */
  async load(trials: Trial[]): Promise<void> {
    const missing = trials.filter(({ chunk }) => chunk !== undefined);
    if (missing.length === 0) return;
    document.body.dataset.loading = String(++this.loads);
    const note = (error: unknown): void => {
      this.lastFault = error instanceof Error ? error.message : String(error);
    };
    await Promise.all(missing.map((trial) => this.chunks.load(trial).catch(note)));
    if (--this.loads === 0) delete document.body.dataset.loading;
  }

  /** Shows another run: the trial with the same start, and the same step, where it has them. */
  chooseRun(run: number): void {
    const trial = matchingTrial(this.trial, this.current.runs[run]);
    void this.show({ ...this.wanted, run, trial: Math.max(0, trial), step: trial < 0 ? undefined : this.selection.step });
  }

  chooseTrial(trial: number): void {
    if (this.current.runs[this.wanted.run].trials[trial]) void this.show({ ...this.wanted, trial, step: undefined, hypothesis: "estimate" });
  }

  /** The trial so many after the one that is shown, or will be. */
  moveTrial(by: number): void {
    this.chooseTrial(this.wanted.trial + by);
  }

  chooseStep(step: number): void {
    if (!this.isLeaving) void this.show({ ...this.selection, step });
  }

  chooseHypothesis(hypothesis: Hypothesis): void {
    if (!this.isLeaving) void this.show({ ...this.selection, hypothesis });
  }

  /** Takes newer data of a run that goes on; who looks at the last step stays at the last step. */
  update(report: Report): void {
    const wasLast = this.selection.step >= this.lastStep;
    const wasTrial = this.trial?.trial;
    const wasNewest = this.selection.trial >= this.run.trials.length - 1;
    this.current = report;
    const trials = this.run.trials;
    const same = trials.findIndex((trial) => trial.trial === wasTrial);
    if ((wasLast && wasNewest) || same < 0) {
      this.selection = { ...this.selection, ...this.newest() };
    } else {
      this.selection = { ...this.selection, trial: same };
      this.selection.step = wasLast ? this.lastStep : Math.min(this.selection.step, this.lastStep);
    }
    this.wanted = this.selection;
    this.runsShown = report.runs;
    this.tell(everything);
  }

  /** Another trial is loaded: whoever goes on to move the steps of this one must not call it off. */
  private get isLeaving(): boolean {
    return this.wanted.run !== this.selection.run || this.wanted.trial !== this.selection.trial;
  }

  /** The last step of the last trial. */
  private newest(): Pick<Selection, "trial" | "step"> {
    const { trials } = this.run;
    const trial = Math.max(0, trials.length - 1);
    return { trial, step: lastOf(trials[trial]?.columns) };
  }

  private select(next: Wanted): void {
    const before = this.selection;
    const steps = this.current.runs[next.run].trials[next.trial]?.columns;
    const step = Number.isInteger(next.step) ? Math.min(Math.max(0, next.step ?? 0), lastOf(steps)) : openingStep(steps);
    this.selection = { ...next, step };
    this.wanted = this.selection;
    const run = next.run !== before.run;
    const trial = run || next.trial !== before.trial;
    const isOtherStep = trial || step !== before.step;
    const hypothesis = isOtherStep || next.hypothesis !== before.hypothesis;
    if (hypothesis) this.tell({ ...nothing, run, trial, step: isOtherStep, hypothesis });
  }

  private tell(change: Change): void {
    for (const listener of this.listeners) listener(change);
  }
}

/** Index of the last step; 0 without any. */
function lastOf(steps: Steps | undefined): number {
  return Math.max(0, (steps?.step.length ?? 0) - 1);
}

/** Where a trial opens: at its declaration, or else at its last step. */
function openingStep(steps: Steps | undefined): number {
  const declared = firstLocalized(steps);
  return declared >= 0 ? declared : lastOf(steps);
}

/** Index of the run's trial that starts where `trial` does; -1 if there is none. */
export function matchingTrial(trial: Trial | undefined, run: Run): number {
  if (!trial) return run.trials.length > 0 ? 0 : -1;
  const { sample, distance_m, stamp } = trial.start;
  return run.trials.findIndex(
    ({ start }) => start.sample === sample && start.distance_m === distance_m && start.stamp === stamp,
  );
}
