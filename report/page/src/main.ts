// The page of glocal report and of glocal run --watch.
import { rankRuns } from "./answers";
import { Chunks } from "./chunks";
import { verdictName } from "./colours";
import { comparisonSection } from "./comparison";
import { Curves } from "./curves";
import type { Report, Run } from "./data";
import { Details } from "./details";
import { append, el, replace } from "./elements";
import { LiveNews } from "./live";
import { MapView } from "./map_view";
import { startPage, themeButton } from "./page_frame";
import { PageState } from "./page_state";
import { Borders, followLength, FullScreen } from "./panes";
import { listenToKeys, Player } from "./player";
import { Ranking } from "./ranking";
import { Store } from "./store";
import { experimentsOf, summaryHeader } from "./summary_header";
import { sweepSection } from "./sweep_section";
import { configurationSection, provenanceSection, summarySection } from "./tables";
import { Distributions, TrialList } from "./trials_section";
import { Views } from "./views";
import { showMeanings } from "./words";

function runPicker(store: Store): HTMLElement | null {
  if (store.report.runs.length < 2) return null;
  const select = el("select", { id: "run", change: () => store.chooseRun(Number(select.value)) });
  store.report.runs.forEach((run, i) => select.append(el("option", { value: i }, run.name)));
  store.subscribe(() => (select.value = String(store.selected.run)));
  return el("label", {}, "run ", select);
}

function trialPicker(store: Store): HTMLElement {
  const select = el("select", { id: "trial", change: () => store.chooseTrial(Number(select.value)) });
  const fill = (): void => {
    const { trials } = store.run;
    replace(
      select,
      ...trials.map((trial, i) => el("option", { value: i }, `${trial.trial}: ${trial.outcome ?? "running"}`)),
    );
    select.disabled = trials.length < 2;
    select.value = String(store.selected.trial);
  };
  fill();
  store.subscribe((change) => {
    if (change.run) fill();
    else if (change.trial) select.value = String(store.selected.trial);
  });
  return el("label", {}, "trial ", select);
}

function keysHelp(): HTMLElement {
  const keys: [string, string][] = [
    ["← →", "step"],
    ["Ctrl ← →", "ten steps"],
    ["Home End", "first, last step"],
    ["space", "play"],
    ["[ ]", "trial"],
    ["+ − 0", "zoom, show all"],
    ["Shift + arrows", "move the map"],
    ["f", "full screen"],
  ];
  return el(
    "aside",
    { class: "keys", "aria-label": "Keys" },
    ...keys.flatMap(([key, meaning]) => [el("kbd", {}, key), ` ${meaning}  `]),
    el("span", {}, "Drag in a curve to zoom it, double-click to zoom out."),
  );
}

/** The experiment, and the run where it is called otherwise. */
function headline(report: Report): HTMLElement {
  const title = el("h1", {}, experimentsOf(report));
  const { runs } = report;
  if (runs.length > 1) append(title, " ", el("small", {}, `${runs.length} runs`));
  else if (runs[0].name !== title.textContent) append(title, " ", el("small", { class: "run-name" }, runs[0].name));
  return title;
}

function links(sections: (HTMLElement | null)[]): HTMLElement {
  const link = (target: HTMLElement): HTMLElement =>
    el("a", { href: `#${target.id}` }, target.querySelector("h2")?.textContent ?? target.id);
  return el("nav", { "aria-label": "Parts of the report" }, ...sections.filter((s) => s !== null).map(link));
}

function hasMoreThanTrials(run: Run): boolean {
  return run.map !== undefined || run.settings["output.steps"]?.text !== "false";
}

async function show(report: Report, page: HTMLElement): Promise<void> {
  if (report.runs.length === 0) throw new Error("the data has no run");
  const isOfMany = report.runs.length > 1;
  if (isOfMany) rankRuns(report);
  const store = new Store(report, new Chunks(report.beside));
  await store.open();
  const map = new MapView(store);
  const views = new Views(store, map);
  const curves = new Curves(store);
  const player = new Player(store);
  const details = new Details(store);
  const trials = new TrialList(store);
  const distributions = new Distributions(store);
  const news = report.live ? new LiveNews(store) : null;
  const redraw = (): void => {
    views.drawNow();
    curves.rebuild();
    distributions.rebuild();
    player.drawStrip();
  };
  // One trial has no distribution.
  const ofTrials = !news && report.runs.some((run) => run.trials.length > 1) ? distributions.element : null;
  // Of many runs this is what is asked for; single steps come after it.
  const before = isOfMany ? [comparisonSection(report), sweepSection(report), ofTrials] : [];
  const after = [
    isOfMany ? null : ofTrials,
    report.runs[0].trials.length > 1 || isOfMany || news ? trials.element : null,
    isOfMany || news ? null : summarySection(report.runs[0]),
    configurationSection(report.runs),
    news ? null : provenanceSection(report),
  ];
  const hasView = !isOfMany || report.runs.some(hasMoreThanTrials);
  const pickers = el("div", { class: "controls" }, runPicker(store), trialPicker(store));
  const view = el("main", { id: "view" }, el("h2", { class: isOfMany ? "" : "unseen" }, "Step by step"));
  const header = el(
    "header",
    {},
    headline(report),
    // Large sweeps keep neither steps nor maps: there is nothing to step through.
    !hasView && pickers,
    themeButton(redraw),
    links([...before, isOfMany && hasView ? view : null, ...after]),
  );
  const borders = new Borders(view);
  const [right, below] = borders.handles;
  append(view, el("div", { class: "view-head" }, hasView && pickers, details.verdict), views.element, right, curves.element, below, player.element, details.element);
  followLength(view, store);
  const fullScreen = new FullScreen(view);
  map.addButton("Full screen (f)", "▢", () => fullScreen.toggle());
  replace(page, header, isOfMany ? new Ranking(store).element : summaryHeader(report.runs[0]), news?.element, ...before);
  if (hasView) append(page, view, keysHelp());
  append(page, ...after);
  showMeanings(page);
  if (hasView) listenToKeys(store, player, views, fullScreen);
  new PageState(store, view, [views, borders]);
  trials.fill();
  if (ofTrials) distributions.fill();
  details.update();
  player.newTrial();
  redraw();
  store.subscribe(() => noteStep(store));
  noteStep(store);
  void news?.listen();
}

/** For whoever looks at the page from outside, as tests do. */
function noteStep(store: Store): void {
  const verdict = store.steps?.verdict[store.selected.step];
  document.body.dataset.run = store.run.name;
  document.body.dataset.trial = String(store.trial?.trial ?? "");
  document.body.dataset.step = String(store.selected.step);
  document.body.dataset.verdict = verdict ? verdictName(verdict) : "";
}

startPage<Report>(show);
