// What the words and symbols of the page mean: a tooltip for each, by pointer or keyboard.
import { el, replace } from "./elements";

/** In the words of docs/glossary.md, sentence by sentence; a test compares them. */
export const ofGlossary: Record<string, string> = {
  "Ω best": "Ω of a step's best hypothesis; 0 without one.",
  "score best": "What a matcher ranks hypotheses by. Thresholds, ratings and verdicts use it. It equals Ω unless the matcher takes further evidence into account.",
  "Ω max": "The least score a hypothesis must reach. The paper's policy is the mean over the last τ steps of the mean score of each step (eq. 9).",
  "Ω′":
    "Mean, over the last τ′ scans, of the share of their hits in contact with the map under the best hypothesis (eq. 10). Near 0 in unknown places.",
  r: "How much a cluster deserves trust: r = α₁ · share of hypotheses + α₂ · (1 − spread in translation) + α₃ · (1 − spread in rotation) + α₄ · mean score (eq. 7).",
  "r̄": "The normalised rating r̄ divides r by the sum over all clusters (eq. 8).",
  cluster: "Hypotheses that mean the same robot pose (eq. 6).",
  hypothesis: "A pose of the local map in the global map, map_from_local, whose score reaches Ω_max. The paper's H.",
  proposal: "A pose before any test of its quality.",
  confidence: "Probability that the pose estimate is right.",
  margin: "Score of the best hypothesis less that of its best rival, a pose elsewhere. Without a rival, less Ω_max.",
  "free space violation": "The share of points that lie where a map or another scan knows the space to be free.",
  "global map": "The known map: points, an occupancy grid, and normals if there are any.",
  "local map": "The points of all observations since the start, joined by a local mapper. Its frame is the robot's first pose.",
  scan: "One sweep of a range finder, in the robot's frame: the hits, the ends of rays that met nothing (free ends), and the sensor's place.",
  estimate: "The pose that the verdict rule holds most likely, declared or not, with a confidence and a covariance if it has them.",
  reference: "The true pose as far as it is known. Only the evaluation sees it.",
  candidates: "In a verdict, candidates are the poses between which it cannot decide.",
  verdict: "What a step says: searching, ambiguous, localized or unknown_place, with a sentence why.",
  trial: "One localization from its start to the declaration, or to the last step allowed.",
  right: "declared, and near the reference.",
  wrong: "declared, and not near it.",
  undecided: "never declared.",
  outcome: "right: declared, and near the reference. wrong: declared, and not near it. undecided: never declared.",
  setting: "What a variant changes, apart from case and seed: what a sweep compares.",
  variant: "The same experiment with some values changed: a setting, on a case, with a seed.",
  seed: "Fixes all random numbers. The same seed gives the same results.",
};

/** What the glossary has no word for. */
const ofPage: Record<string, string> = {
  new: "Hits of the scan where the map shows nothing, nor on the way, seen from the estimate: what the map lacks. Boxes: what three scans of the trial tell.",
  gone: "Hits of the scan beyond what the map shows on the way, seen from the estimate: something is gone, or the pose is wrong. Boxes: what three scans of the trial pass through.",
  error: "How far the estimate is from the reference pose, and turned against it.",
  "angle error": "How far the estimate is turned against the reference pose: the median of right trials, at the declaration.",
  "error at declaration": "How far the estimate is from the reference pose: the median of right trials, at the declaration.",
  steps: "Steps up to the declaration: the median of right trials.",
  way: "How far the robot drove up to the declaration: the median of right trials.",
  "wall time of a step": "Wall-clock time of a whole step: local map, matching, clustering and rating. The median of all steps.",
  time: "Wall-clock time of this step, and of the matching in it.",
  "time per match": "Wall-clock time of the matching in each step.",
  failed: "Ended by an error of a strategy, which the trial's sentence names.",
  declared: "Declared, where no reference says whether that is right.",
  "run or setting": "What one results folder holds, or all those of a setting: over cases and seeds. The button shows one of them step by step.",
  trials: "All trials of the run, or of the setting: of all its cases and seeds.",
  success: "Share of right trials among all, with its 95 % interval.",
  "success judged": "Share of right trials where nothing was chosen, with its 95 % interval: the number to report.",
  "score of a setting": "Right less wrong trials, in points of 100 of all. Settings are ranked by it.",
  "errors at declaration": "How far the estimate is from the reference pose, and turned against it: medians of right trials, at the declaration.",
  "time, and of the slowest": "Wall-clock time of a whole step: the median of all steps, and what 95 % of them do not exceed.",
  "time of matching": "Wall-clock time of the matching in a step: the median of all steps.",
  "points of the map": "Points of the global map, as matchers take them.",
  "memory, largest": "The most memory that the program held at once.",
  measure: "What is compared: of all shared starts how trials ended, and of those at which both runs are right the rest.",
  method: "All runs of a method, or of a setting, over cases and seeds.",
  "right (95 %)": "Share of right trials, with its 95 % interval.",
  "wrong (95 %)": "Share of wrong trials, with its 95 % interval.",
  "undecided (95 %)": "Share of trials that were never declared, with its 95 % interval.",
  "baseline's": "The baseline's number of trials, or its median.",
  "variant's": "The variant's number of trials, or its median.",
  "difference (95 %)": "Variant less baseline at the same starts, with its 95 % interval.",
  p: "How likely a difference no smaller would be if both runs were alike, made larger for the number of tests that were made. Bold: significant.",
  "start of a trial": "How far along the drive the trial begins.",
  "steps of a trial": "Steps up to the declaration; without one, all that the trial had.",
  "way of a trial": "How far the robot drove up to the declaration; without one, in the whole trial.",
  "error, m": "How far the declared pose is from the reference pose.",
  "error, °": "How far the declared pose is turned against the reference pose.",
  "contact certified": "How much of the local map is in contact with the map at the declared pose, and how much at most at any pose elsewhere.",
  why: "The sentence of the verdict that the trial ended with, or of what made it fail.",
  "ε, range noise": "The distance that counts as contact in this step, and the standard deviation of ranges as the scans tell it.",
  evidence: "A number that the verdict rests on.",
  "evidence: steps": "For how many steps the best pose has been the same, moved by the local motion.",
  "evidence: distance_m": "How far the robot drove in these steps.",
  "evidence: turn_rate_deg": "How fast the robot turned since the step before, in degrees a second.",
  "x, y, θ": "Pose of the robot in the map: m, and degrees counter-clockwise from the map's x.",
  space: "Light: known to be free. Grey: nothing is known.",
  grid: "Lines with the map's coordinates in m.",
  "field of view": "What the laser saw of the room in this step, up to what it met.",
  ends: "Where the trial begins and ends: by the reference, or else by the estimates.",
  "unknown place": "Where the robot was in steps whose verdict is that this place is not on the map.",
};

const same: Record<string, string> = {
  "Best quality Ω": "Ω best",
  "Threshold Ω max": "Ω max",
  "Known place Ω′": "Ω′",
  "Time per match": "time per match",
  "Error of translation": "error, m",
  "Error of rotation": "error, °",
  Clusters: "cluster",
  clusters: "cluster",
  hypotheses: "hypothesis",
  proposals: "proposal",
  "x, m": "x, y, θ",
  "y, m": "x, y, θ",
  "θ, °": "x, y, θ",
  "right, wrong, undecided": "outcome",
  "declared, not judged": "declared",
  "experiment, seed": "seed",
  "evidence: margin": "margin",
  "evidence: free_space_violation": "free space violation",
  "steps to localize, median": "steps",
  "distance to localize, median": "way",
  "error when localized, median": "errors at declaration",
  "wall time of a step, median (95 %)": "time, and of the slowest",
  "matching, median": "time of matching",
};

export function meaningOf(word: string): string | undefined {
  const key = same[word] ?? word;
  return ofGlossary[key] ?? ofPage[key] ?? (word.startsWith("evidence: ") ? ofPage.evidence : undefined);
}

/** Makes an element tell what it means; nothing for words that mean nothing in particular. */
export function explained<E extends HTMLElement>(element: E, word: string = element.textContent ?? ""): E {
  const meaning = meaningOf(word.trim());
  return meaning === undefined ? element : withMeaning(element, meaning);
}

export function withMeaning<E extends HTMLElement>(element: E, meaning: string): E {
  element.classList.add("word");
  element.dataset.meaning = meaning;
  element.tabIndex = 0;
  return element;
}

/** One tooltip for all words of the page. */
export function showMeanings(page: HTMLElement): void {
  const tip = el("div", { id: "meaning", class: "meaning", role: "tooltip", hidden: true });
  let shown: HTMLElement | null = null;
  let described: Element | null = null;
  const hide = (): void => {
    tip.hidden = true;
    described?.removeAttribute("aria-describedby");
    shown = described = null;
  };
  const show = (event: Event): void => {
    const word = event.target instanceof Element ? event.target.closest<HTMLElement>("[data-meaning]") : null;
    // What has the focus keeps its meaning in sight, wherever the pointer is.
    if (word === shown || (!word && shown?.contains(document.activeElement))) return;
    hide();
    if (!word) return;
    shown = word;
    described = event.type === "focusin" && event.target instanceof Element ? event.target : word;
    described.setAttribute("aria-describedby", tip.id);
    replace(tip, word.dataset.meaning ?? "");
    tip.hidden = false;
    place();
  };
  /** Below the word, or above it where there is no room. */
  const place = (): void => {
    if (!shown) return;
    const at = shown.getBoundingClientRect();
    const left = Math.max(8, Math.min(at.left, document.documentElement.clientWidth - tip.offsetWidth - 8));
    const isBelow = at.bottom + tip.offsetHeight + 8 < window.innerHeight;
    tip.style.left = `${left}px`;
    tip.style.top = `${isBelow ? at.bottom + 4 : Math.max(4, at.top - tip.offsetHeight - 4)}px`;
  };
  page.addEventListener("mouseover", show);
  page.addEventListener("focusin", show);
  page.addEventListener("focusout", hide);
  window.addEventListener("scroll", place, { passive: true });
  document.addEventListener("keydown", (event) => event.key === "Escape" && hide());
  document.body.append(tip);
}
