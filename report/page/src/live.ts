// News of a run that goes on, from the program that serves this page.
import type { Live, Report } from "./data";
import { el, replace } from "./elements";
import { duration } from "./numbers";
import type { Store } from "./store";

const shortest = 500; // ms, from one question to the next

export class LiveNews {
  readonly element = el("div", { class: "live", role: "status" });
  private readonly bar = el("progress", { max: 1, value: 0 });
  private readonly text = el("span", {});

  constructor(private readonly store: Store) {
    replace(this.element, this.bar, this.text);
    if (store.report.live) this.tell(store.report.live);
  }

  async listen(): Promise<void> {
    let version = this.store.report.live?.version ?? 0;
    for (;;) {
      const asked = performance.now();
      let report: Report | null = null;
      try {
        const answer = await fetch(`data?version=${version}`, { cache: "no-store" });
        report = answer.status === 200 ? ((await answer.json()) as Report) : null;
      } catch {
        this.ended();
        return;
      }
      if (report?.live) {
        // Another variant has other settings, perhaps another map, and a page opened before the map was loaded has neither: a new page.
        const hasFirstMap = this.store.run.map === undefined && report.runs[0].map !== undefined;
        if (report.live.variant !== this.store.report.live?.variant || hasFirstMap) location.reload();
        version = report.live.version;
        this.tell(report.live);
        this.store.update(report);
        if (report.live.finished) return;
      }
      // Large answers are asked for less often, so that watching costs the run little; but towards the end often, as
      // the program does not wait long to tell it.
      const took = performance.now() - asked;
      const remaining = report?.live?.remaining_s ?? Infinity;
      const pause = remaining < 10 ? shortest : Math.max(shortest, 10 * took);
      await new Promise((resolve) => setTimeout(resolve, pause));
    }
  }

  private tell(live: Live): void {
    const name = live.variant ? `${live.experiment}: ${live.variant}` : live.experiment;
    this.bar.max = Math.max(1, live.trials);
    this.bar.value = live.trials_done;
    const rest = live.remaining_s === undefined || live.finished ? "" : `, ${duration(live.remaining_s)} left`;
    const state = live.finished ? "finished" : "running";
    replace(this.text, `${name}: ${state}, ${live.trials_done} of ${live.trials} trials${rest}`);
  }

  private ended(): void {
    replace(this.text, `${this.text.textContent ?? ""}. The program does not answer any more: this is the last it told.`);
  }
}
