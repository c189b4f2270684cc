// The slider over the steps, with play and keys.
import { themeColour, verdictColours, verdictName } from "./colours";
import { el, replace } from "./elements";
import type { MapView } from "./map_view";
import type { FullScreen } from "./panes";
import type { Store } from "./store";
import { iconButton } from "./zoom_buttons";

const speeds = [2, 5, 10, 30]; // steps a second

export class Player {
  readonly element: HTMLElement;
  private readonly slider = el("input", { type: "range", min: 0, value: 0, step: 1, "aria-label": "Step" });
  private readonly strip = el("canvas", { class: "strip", "aria-hidden": "true" });
  private readonly told = el("output", { class: "step" });
  private readonly playButton = el("button", { type: "button", class: "play", click: () => this.toggle() });
  private readonly speed = el("select", { "aria-label": "Speed" });
  private timer = 0;

  constructor(private readonly store: Store) {
    speeds.forEach((speed) => this.speed.append(el("option", { value: speed, selected: speed === 10 }, `${speed} steps/s`)));
    this.speed.addEventListener("change", () => this.timer && this.play());
    this.slider.addEventListener("input", () => this.store.chooseStep(Number(this.slider.value)));
    this.element = el(
      "div",
      { class: "player", role: "group", "aria-label": "Steps" },
      iconButton("First step (Home)", "|◀", () => this.store.chooseStep(0)),
      iconButton("Step back (←)", "◀", () => this.move(-1)),
      this.playButton,
      iconButton("Step on (→)", "▶", () => this.move(1)),
      iconButton("Last step (End)", "▶|", () => this.store.chooseStep(this.store.lastStep)),
      el("div", { class: "track" }, this.strip, this.slider),
      this.told,
      this.speed,
    );
    this.showPlaying();
    store.subscribe((change) => {
      if (change.trial) this.newTrial();
      if (change.step) this.showStep();
    });
    new ResizeObserver(() => this.drawStrip()).observe(this.strip);
  }

  newTrial(): void {
    this.slider.max = String(this.store.lastStep);
    this.drawStrip();
    this.showStep();
  }

  /** By so many steps; the page goes no further than its ends. */
  move(steps: number): void {
    this.store.chooseStep(this.store.selected.step + steps);
  }

  toggle(): void {
    if (this.timer) this.pause();
    else this.play();
  }

  private play(): void {
    this.pause();
    if (this.store.selected.step >= this.store.lastStep) this.store.chooseStep(0);
    this.timer = window.setInterval(() => {
      if (this.store.selected.step >= this.store.lastStep) this.pause();
      else this.move(1);
    }, 1000 / Number(this.speed.value));
    this.showPlaying();
  }

  private pause(): void {
    window.clearInterval(this.timer);
    this.timer = 0;
    this.showPlaying();
  }

  private showPlaying(): void {
    const label = this.timer ? "Pause (space)" : "Play (space)";
    this.playButton.title = label;
    this.playButton.setAttribute("aria-label", label);
    replace(this.playButton, this.timer ? "❚❚" : "►");
  }

  private showStep(): void {
    const { step } = this.store.selected;
    const { steps } = this.store;
    this.slider.value = String(step);
    const verdict = steps?.verdict[step];
    this.slider.setAttribute("aria-valuetext", verdict ? `step ${step}, ${verdictName(verdict)}` : `step ${step}`);
    replace(this.told, verdict ? `step ${step} of ${this.store.lastStep}` : "no steps");
  }

  /** The verdict of every step, as a strip of colours above the slider. */
  drawStrip(): void {
    const width = this.strip.clientWidth;
    const context = this.strip.getContext("2d");
    if (!context || width === 0) return;
    this.strip.width = width;
    this.strip.height = 6;
    context.fillStyle = themeColour("grid");
    context.fillRect(0, 0, width, 6);
    const verdicts = this.store.steps?.verdict ?? [];
    const each = width / Math.max(1, verdicts.length);
    verdicts.forEach((verdict, i) => {
      context.fillStyle = verdictColours[verdict];
      context.fillRect(i * each, 0, Math.max(1, Math.ceil(each)), 6);
    });
  }
}

/** Keys that work wherever no text is being written. */
export function listenToKeys(
  store: Store,
  player: Player,
  map: Pick<MapView, "pan" | "zoom" | "fit">,
  fullScreen: FullScreen,
): void {
  const keys: Record<string, (event: KeyboardEvent) => void> = {
    ArrowLeft: (event) => (event.shiftKey ? map.pan(60, 0) : player.move(event.ctrlKey ? -10 : -1)),
    ArrowRight: (event) => (event.shiftKey ? map.pan(-60, 0) : player.move(event.ctrlKey ? 10 : 1)),
    ArrowUp: (event) => event.shiftKey && map.pan(0, 60),
    ArrowDown: (event) => event.shiftKey && map.pan(0, -60),
    Home: () => store.chooseStep(0),
    End: () => store.chooseStep(store.lastStep),
    " ": () => player.toggle(),
    "+": () => map.zoom(1.5),
    "=": () => map.zoom(1.5),
    "-": () => map.zoom(1 / 1.5),
    "0": () => map.fit(),
    f: () => fullScreen.toggle(),
    "[": () => store.moveTrial(-1),
    "]": () => store.moveTrial(1),
  };
  document.addEventListener("keydown", (event) => {
    const { target } = event;
    const work = keys[event.key];
    if (!work || event.altKey || event.metaKey || !(target instanceof HTMLElement)) return;
    // The browser has its own work for other keys with Ctrl, such as the size of its letters.
    if (event.ctrlKey && !/^Arrow(Left|Right)$/.test(event.key)) return;
    if (target.matches("select, textarea, input:not([type=range]):not([type=checkbox])")) return;
    if (event.key === " " && target.matches("button, input, summary, a")) return;
    // The slider of heights is moved by the same keys as that of the steps.
    if (/^(Arrow|Home|End)/.test(event.key) && target.matches(".cut input")) return;
    const scrolls = (event.key === "ArrowUp" || event.key === "ArrowDown") && !event.shiftKey;
    // Wide tables scroll by arrows, and the page by Home and End where a table has the focus.
    if (scrolls || target.matches(".scroll, [role=separator]")) return;
    event.preventDefault();
    work(event);
  });
}
