// What is shown at the moment. Whoever shows something of it listens for changes.
import { firstLocalized, type Report, type Run, type Steps, type Trial } from "./data";

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
}

type Listener = (change: Change) => void;

export class Store {
  private selection: Selection = { run: 0, trial: 0, step: 0, hypothesis: "estimate" };
  private listeners: Listener[] = [];

  constructor(private current: Report) {
    if (current.live) this.selection = { ...this.selection, ...this.newest() };
    else this.selection.step = openingStep(this.steps);
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
  get trial(): Trial | undefined {
    return this.run.trials[this.selection.trial];
  }
  get steps(): Steps | undefined {
    return this.trial?.columns;
  }
  get lastStep(): number {
    return Math.max(0, (this.steps?.step.length ?? 0) - 1);
  }

  subscribe(listener: Listener): void {
    this.listeners.push(listener);
  }

  /** Shows all of this; without a step that which the trial opens at. */
  show({ step, ...rest }: Omit<Selection, "step"> & { step: number | undefined }): void {
    const steps = this.current.runs[rest.run].trials[rest.trial]?.columns;
    const isStep = step !== undefined && Number.isInteger(step);
    this.select({ ...rest, step: isStep ? step : openingStep(steps) });
  }

  /** Shows another run: the trial with the same start, and the same step, where it has them. */
  chooseRun(run: number): void {
    const trial = matchingTrial(this.trial, this.current.runs[run]);
    this.select({ ...this.selection, run, trial: trial < 0 ? 0 : trial });
  }

  chooseTrial(trial: number): void {
    const chosen = this.run.trials[trial];
    if (chosen) this.select({ ...this.selection, trial, step: openingStep(chosen.columns), hypothesis: "estimate" });
  }

  chooseStep(step: number): void {
    this.select({ ...this.selection, step });
  }

  chooseHypothesis(hypothesis: Hypothesis): void {
    this.select({ ...this.selection, hypothesis });
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
    this.tell({ run: true, trial: true, step: true, hypothesis: true });
  }

  /** The last step of the last trial. */
  private newest(): Pick<Selection, "trial" | "step"> {
    const { trials } = this.run;
    const trial = Math.max(0, trials.length - 1);
    return { trial, step: Math.max(0, (trials[trial]?.columns?.step.length ?? 0) - 1) };
  }

  private select(next: Selection): void {
    const before = this.selection;
    this.selection = next;
    const step = Math.min(Math.max(0, next.step), this.lastStep);
    this.selection = { ...next, step };
    const run = next.run !== before.run;
    const trial = run || next.trial !== before.trial;
    const change = {
      run,
      trial,
      step: trial || step !== before.step,
      hypothesis: trial || step !== before.step || next.hypothesis !== before.hypothesis,
    };
    if (change.hypothesis) this.tell(change);
  }

  private tell(change: Change): void {
    for (const listener of this.listeners) listener(change);
  }
}

/** Where a trial opens: at its declaration, or else at its last step. */
function openingStep(steps: Steps | undefined): number {
  const declared = firstLocalized(steps);
  return declared >= 0 ? declared : Math.max(0, (steps?.step.length ?? 0) - 1);
}

/** Index of the run's trial that starts where `trial` does; -1 if there is none. */
export function matchingTrial(trial: Trial | undefined, run: Run): number {
  if (!trial) return run.trials.length > 0 ? 0 : -1;
  const { sample, distance_m, stamp } = trial.start;
  return run.trials.findIndex(
    ({ start }) => start.sample === sample && start.distance_m === distance_m && start.stamp === stamp,
  );
}
