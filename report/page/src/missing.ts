// What the results do not hold, so that no drawing can show it.
import type { Store } from "./store";

/** In sentences. */
export function whatIsMissing({ map, trial, steps, fault }: Store): string[] {
  const missing: string[] = [];
  if (!map) missing.push("The results hold no global map (output.maps: none, or the first trial is missing).");
  if (!trial) missing.push("No trial was finished.");
  else if (trial.chunk !== undefined && fault) missing.push(`${fault}.`);
  else if (!steps) missing.push("The results hold no steps (output.steps: false).");
  return missing;
}
