// Whose trials are looked at together: those of a run, and in a sweep those of a setting.
import type { Report, Trial } from "./data";

export interface Group {
  name: string;
  trials: Trial[];
}

/** In a sweep over cases or seeds its settings, best first, each with the trials of all its runs; else the runs. */
export function groupsOf({ runs, sweep }: Report): Group[] {
  const names = sweep?.settings.map(({ setting }) => setting) ?? [];
  const settingOf = (name: string): string | undefined =>
    names.filter((setting) => setting !== "" && (name === setting || name.startsWith(`${setting}_`))).sort((a, b) => b.length - a.length)[0];
  const settings = runs.map((run) => settingOf(run.name));
  // The experiment itself may be a setting; its runs have the names of cases and seeds.
  if (names.length === 0 || names.length === runs.length || settings.includes(undefined)) return runs;
  return names.map((name) => ({ name, trials: runs.flatMap((run, i) => (settings[i] === name ? run.trials : [])) }));
}
