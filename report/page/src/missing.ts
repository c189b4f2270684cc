// What views of the map say in words: which step they show, and what the results do not hold, so that no drawing can show it.
import { verdictName } from "./colours";
import { frameAt } from "./data";
import type { Store } from "./store";

/** For those who cannot see the picture. */
export function shownIn(picture: string, { steps, trial, selected: { step } }: Store): string {
  const verdict = steps?.verdict[step];
  return steps && verdict ? `${picture} at step ${step} of trial ${trial?.trial}: ${verdictName(verdict)}, ${steps.clusters[step]} clusters` : picture;
}

/** In sentences. */
export function whatIsMissing({ map, trial, steps, fault }: Store): string[] {
  const missing: string[] = [];
  if (!map) missing.push("The results hold no global map (output.maps: none, or the first trial is missing).");
  if (!trial) missing.push("No trial was finished.");
  else if (trial.chunk !== undefined && fault) missing.push(`${fault}.`);
  else if (!steps) missing.push("The results hold no steps (output.steps: false).");
  return missing;
}

/** The same of a step that is drawn, and of what is laid under the chosen pose, if it has that. */
export function missingOfStep({ report, steps, trial, selected }: Store, hasPose: boolean): string[] {
  if (!steps || steps.step.length === 0) return [];
  const { step, hypothesis } = selected;
  const missing: string[] = [];
  const listed = steps.best.first[step + 1] - steps.best.first[step];
  if (listed < steps.clusters[step]) missing.push(`The ${listed} best of ${steps.clusters[step]} clusters.`);
  if (!hasPose) missing.push(`${hypothesis === "estimate" ? "No hypothesis in this step" : "This step has no such pose"}: nothing to lay the local map under.`);
  const lives = trial?.local_map;
  const frame = lives ? frameAt(lives, step) : -1;
  if (report.live && frame < 0) missing.push("While the run goes on, only the newest step has its local map.");
  else if (!lives) missing.push("Local maps of this trial were not recorded (output.maps: all records every trial's).");
  else if (frame >= 0 && lives.steps[frame] !== step) missing.push(`The local map is that of step ${lives.steps[frame]}.`);
  return missing;
}
