// The page's address tells what is shown, so that a link leads others there.
import type { Hypothesis, Store } from "./store";
import type { Linked } from "./view_change";

const pause = 250; // ms; browsers allow few changes of the address in a second

export class PageState {
  private timer = 0;
  /** What the address says, or would say of the page as it was opened. */
  private known = "";
  /** The address as it was read or written last. */
  private hash = location.hash;

  constructor(
    private readonly store: Store,
    page: HTMLElement,
    private readonly parts: Linked[],
  ) {
    // Of a run that goes on, the page shows the newest step.
    if (store.report.live) return;
    this.known = this.address();
    void this.read();
    window.addEventListener("hashchange", () => void this.read());
    store.subscribe(() => this.writeSoon());
    page.addEventListener("viewchange", () => this.writeSoon());
  }

  /** What is not said is as on a page that was just opened. An address of a part of the page says nothing. */
  private async read(): Promise<void> {
    this.hash = location.hash;
    const hash = this.hash.slice(1);
    if (!hash.includes("=")) return;
    const said = new URLSearchParams(hash);
    const { runs } = this.store.report;
    const run = Math.max(0, runs.findIndex(({ name }) => name === said.get("run")));
    const number = said.get("trial");
    const trial = Math.max(0, runs[run].trials.findIndex(({ trial: its }) => String(its) === number));
    const step = said.get("step");
    const wanted = { run, trial, step: step === null ? undefined : Number(step), hypothesis: hypothesisOf(said.get("pose")) };
    // Places are of the map of that run, which comes with its trial.
    if (!(await this.store.show(wanted))) return;
    for (const part of this.parts) part.setState(said);
    this.known = this.address();
  }

  private writeSoon(): void {
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.write(), pause);
  }

  private write(): void {
    const address = this.address();
    if (address === this.known) return;
    // Somebody changed the address a moment ago. It is read next, and must not be lost.
    if (location.hash !== this.hash) return;
    this.known = address;
    try {
      history.replaceState(null, "", `#${address}`);
      this.hash = location.hash;
    } catch {
      // Pages within other pages may have no address of their own.
    }
  }

  private address(): string {
    const { run, trial, selected } = this.store;
    const said = new URLSearchParams({ run: run.name });
    if (trial) said.set("trial", String(trial.trial));
    said.set("step", String(selected.step));
    if (selected.hypothesis !== "estimate") said.set("pose", String(selected.hypothesis));
    for (const part of this.parts) for (const [name, value] of Object.entries(part.state())) said.set(name, value);
    return said.toString();
  }
}

/** Clusters count from 0. */
function hypothesisOf(text: string | null): Hypothesis {
  if (text === "reference") return text;
  return text !== null && /^\d+$/.test(text) ? Number(text) : "estimate";
}
