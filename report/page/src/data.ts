// What the program puts in the page. Lengths in m (points of maps and scans in whole mm), angles in rad, times
// in ms unless a name says otherwise.

export const metres = 1e-3; // of the whole mm in which points are given

/** null where a step has no such value. */
export type Column = (number | null)[];

/** Of runs in space only: height, and the rotation as a unit quaternion. */
export type SpaceColumns = Partial<Record<"z" | "qx" | "qy" | "qz" | "qw", Column>>;

export type PoseColumns = SpaceColumns & Record<"x" | "y" | "theta", Column>;

export interface Pose {
  x: number;
  y: number;
  theta: number;
}

/** What a search of the whole map proves of a declared pose. Contacts are shares of 1. */
export interface Certificate {
  contact: number;
  /** No pose farther away than the two below has more. */
  at_most: number;
  distance_m: number;
  rotation_deg: number;
}

/** A declared pose against all others. */
export interface Verification {
  step: number;
  refuted: boolean;
  score: number;
  /** A rival refutes if its score is at most this much lower. */
  margin: number;
  rivals: { pose: Pose; contact: number; score: number }[];
  /** The search has not come to its end. */
  goes_on?: boolean;
  /** Absent where the search goes on, or was given up. */
  certificate?: Certificate;
}

export type VerdictKind = "searching" | "ambiguous" | "localized" | "unknown_place";

/** One value a step in each. */
export interface Steps {
  step: number[];
  /** Wall-clock time of the whole step, and of the matching in it. */
  step_ms: number[];
  match_ms: number[];
  local_map_points: number[];
  omega_best: number[];
  score_best: number[];
  omega_max: number[];
  omega_place: Column;
  proposals: number[];
  hypotheses: number[];
  clusters: number[];
  verdict: VerdictKind[];
  /** Indexes into `sentences`. */
  why: number[];
  sentences: string[];
  /** A letter for each hit of the scan: n new, b beyond what the map shows. */
  hits: string[];
  translation_error_m: Column;
  rotation_error_deg: Column;
  confidence: Column;
  contact_epsilon_m: Column;
  range_noise_m: Column;
  estimate: PoseColumns;
  reference: PoseColumns;
  local_from_robot: PoseColumns;
  /** x, y, theta of each candidate, one after the other. */
  candidates: number[][];
  /** z, qx, qy, qz, qw of each candidate; of runs in space only. */
  candidates_in_space?: number[][];
  /** Of the steps in which a declaration was verified. */
  verifications?: Verification[];
  evidence: Record<string, Column>;
  /** The clusters of step i are [first[i], first[i + 1]), falling rating. */
  best: SpaceColumns & Record<"first" | "x" | "y" | "theta" | "size" | "r" | "r_normalised", number[]>;
}

/** Points that come and go: each lives in the frames [from, to). */
export interface PointLives {
  /** The step that each frame was recorded after. */
  steps: number[];
  x: number[];
  y: number[];
  /** Of runs in space only, as in scans and maps. */
  z?: number[];
  from: number[];
  to: number[];
}

/** The points of recorded scan i are [first[i], first[i + 1]), in the robot's frame. */
export interface Scans {
  steps: number[];
  first: number[];
  x: number[];
  y: number[];
  z?: number[];
}

/** A box along the axes of the map's frame, m, and how many scans tell it. */
export interface MapChange {
  x: number;
  y: number;
  width: number;
  height: number;
  views: number;
}

/** What the map lacks, and what it shows that is gone. */
export interface MapChanges {
  new: MapChange[];
  gone: MapChange[];
}

export type Outcome = "right" | "wrong" | "undecided" | "declared" | "failed";

export interface Trial {
  trial: number;
  start: { sample: number; distance_m: number; stamp: number; reference?: Pose };
  /** Absent while the trial runs. */
  outcome?: Outcome;
  /** Up to the declaration; all of them if there is none. */
  steps?: number;
  distance_m?: number;
  pose?: Pose;
  translation_error_m?: number;
  rotation_error_deg?: number;
  confidence?: number;
  certificate?: Certificate;
  why?: string;
  /** Names what holds the three below, until it is loaded; absent where the trial has left none of them. */
  chunk?: number;
  /** Absent where steps were not written. */
  columns?: Steps;
  local_map?: PointLives;
  scans?: Scans;
  /** What the trial has found to differ from the map, where its local maps are kept. */
  changes?: MapChanges;
}

export interface Proportion {
  value: number;
  low: number;
  high: number;
}

export interface Quantiles {
  median: number;
  p90?: number;
  p95?: number;
  max?: number;
}

export interface Summary {
  name: string;
  seed: number;
  complete: boolean;
  trials: { count: number; right: number; wrong: number; undecided: number; failed?: number; declared_without_reference?: number };
  /** Of all trials, written or not. */
  steps: number;
  success_rate: Proportion;
  false_rate: Proportion;
  steps_to_localize: Quantiles;
  distance_to_localize_m: Quantiles;
  translation_error_m: Quantiles;
  rotation_error_deg: Quantiles;
  step_ms: Quantiles;
  stage_ms: Record<"local_map" | "match" | "cluster" | "rate", Quantiles>;
  map: { points: number; build_ms: number; index_ms: number };
  peak_rss_mb: number;
}

export interface Setting {
  text: string;
  /** The hash of the file it names; files are the same if their content is. */
  identity?: string;
}

/** Of what experiment's variants, cases and seeds the run is. */
export interface Part {
  setting: string;
  case: string;
  role: "none" | "choose" | "judge";
  seed: number;
  /** What the setting changes, by path. */
  values: Record<string, string>;
}

export type Provenance = Record<string, unknown> & { variant?: Part };

export interface Run {
  name: string;
  folder: string;
  /** Absent while the run goes on. */
  summary?: Summary;
  provenance?: Provenance;
  settings: Record<string, Setting>;
  /** Index into `maps`. */
  map?: number;
  trials: Trial[];
  /** Wall-clock times of steps, ascending: all, or as many as distributions are drawn from. Absent while the run goes on. */
  step_ms?: number[];
  /** How many steps these are of. */
  timed_steps?: number;
}

/** What is known of square cells: row 0 has the lowest y of the grid's frame. */
export interface Grid {
  resolution: number;
  /** The outer corner of the first cell, and the direction of the rows. */
  origin: Pose;
  width: number;
  height: number;
  /** Run lengths, row by row: "12u3f1o" is 12 unknown, 3 free, 1 occupied. */
  cells: string;
}

export interface GlobalMap {
  x: number[];
  y: number[];
  z?: number[];
  spacing_m: number;
  /** Absent where a map has points only. */
  grid?: Grid;
}

/** How the trials of a setting ended; rates are shares of 1. */
export interface SettingOutcome {
  trials: number;
  right: number;
  wrong: number;
  undecided: number;
  success_rate: Proportion;
  score: number;
  /** Absent where no trial was right. */
  median_steps?: number;
}

export interface SweepLevel {
  label: string;
  settings: number;
  trials: number;
  success_rate: Proportion;
}

export interface ParameterEffect {
  path: string;
  label: string;
  /** Levels are quarters of the values. */
  quarters: boolean;
  range: number;
  spearman?: number;
  levels: SweepLevel[];
}

export interface SweepAxis {
  path: string;
  label: string;
  levels: string[];
}

export interface SweepMap {
  rows: SweepAxis;
  columns: SweepAxis;
  cells: { settings: number; trials: number; success_rate: Proportion }[][];
}

export interface Sweep {
  choose_on: string[];
  judge_on: string[];
  warnings: string[];
  /** Best first. */
  settings: {
    setting: string;
    /** What it changes, by path. */
    values: Record<string, string>;
    complete: boolean;
    chosen: SettingOutcome;
    judged?: SettingOutcome;
  }[];
  /** Largest first. */
  effects: ParameterEffect[];
  map?: SweepMap;
}

export interface Live {
  experiment: string;
  variant: string;
  trials_done: number;
  trials: number;
  remaining_s?: number;
  finished: boolean;
  version: number;
}

/** Where the steps of trials are, if not in the page: scripts FOLDER/HASH_0.js and so on. */
export interface Beside {
  folder: string;
  hash: string;
  /** The first chunk of each script. */
  first: number[];
}

export interface Report {
  format: number;
  generator: string;
  beside?: Beside;
  live?: Live;
  maps: GlobalMap[];
  runs: Run[];
  /** As comparison.ts reads it. */
  comparison?: unknown;
  comparison_refused?: string;
  sweep?: Sweep;
}

export function isInSpace({ maps }: Report): boolean {
  return maps.some((map) => map.z !== undefined);
}

export function poseAt(poses: PoseColumns, i: number): Pose | null {
  const x = poses.x[i];
  const y = poses.y[i];
  const theta = poses.theta[i];
  return x == null || y == null || theta == null ? null : { x, y, theta };
}

/** The newest frame recorded up to this step; -1 if there is none. */
export function frameAt(lives: PointLives | Scans, step: number): number {
  let frame = -1;
  while (frame + 1 < lives.steps.length && lives.steps[frame + 1] <= step) ++frame;
  return frame;
}

/** Number of the first step whose verdict is `localized`; -1 if there is none. */
export function firstLocalized(steps: Steps | undefined): number {
  return steps ? steps.verdict.indexOf("localized") : -1;
}
