// How the parts of the view share the page: borders that can be moved, the map alone on the whole screen, and what a trial of one
// step needs not.
import { el } from "./elements";
import type { Store } from "./store";
import { tellView, type Linked } from "./view_change";

interface BorderKind {
  name: string;
  /** In the page's address. */
  key: string;
  orientation: "vertical" | "horizontal";
  /** Of what the border sets: percent of the width, or px. */
  least: number;
  most: number;
  start: number;
  step: number;
  /** From where the pointer is. */
  valueAt: (event: PointerEvent, view: HTMLElement) => number;
  style: (value: number) => Record<string, string>;
}

const borders: BorderKind[] = [
  {
    name: "Width of the map",
    key: "width",
    orientation: "vertical",
    least: 20,
    most: 80,
    start: 46,
    step: 2,
    valueAt: (event, view) => {
      const { left, width } = view.getBoundingClientRect();
      return (100 * (event.clientX - left)) / width;
    },
    style: (value) => ({ "--map-width": `${value}fr`, "--curves-width": `${100 - value}fr` }),
  },
  {
    name: "Height of the map",
    key: "height",
    orientation: "horizontal",
    least: 200,
    most: 2000,
    start: 560,
    step: 20,
    valueAt: (event, view) => event.clientY - (view.querySelector(".stage")?.getBoundingClientRect().top ?? 0) - 10,
    style: (value) => ({ "--map-height": `${value}px` }),
  },
];

/** What moves a border, by pointer or by arrow keys; a double click puts it where it was. */
class Border {
  readonly handle: HTMLElement;
  /** Null where the style sheet has it. */
  private value: number | null = null;

  constructor(
    private readonly view: HTMLElement,
    readonly how: BorderKind,
  ) {
    const { name, orientation, least, most, start, step } = how;
    const isAcross = orientation === "vertical";
    const keys: Record<string, number> = isAcross ? { ArrowLeft: -1, ArrowRight: 1 } : { ArrowUp: -1, ArrowDown: 1 };
    this.handle = el("div", {
      class: `border ${orientation}`,
      role: "separator",
      tabindex: 0,
      title: `${name}: drag, or arrow keys`,
      "aria-label": name,
      "aria-orientation": orientation,
      "aria-valuemin": least,
      "aria-valuemax": most,
      "aria-valuenow": start,
      dblclick: () => this.move(null),
    });
    const { handle } = this;
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      event.preventDefault();
      handle.focus();
    });
    handle.addEventListener("pointermove", (event) => {
      if (handle.hasPointerCapture(event.pointerId)) this.move(how.valueAt(event, view));
    });
    handle.addEventListener("keydown", (event) => {
      const direction = keys[event.key];
      if (direction === undefined) return;
      event.preventDefault();
      this.move((this.value ?? start) + direction * step);
    });
  }

  get state(): number | null {
    return this.value;
  }

  set(wanted: number | null): void {
    const { least, most, start, style } = this.how;
    this.value = wanted === null ? null : Math.round(Math.min(Math.max(wanted, least), most));
    for (const [name, text] of Object.entries(style(this.value ?? start)))
      this.view.style.setProperty(name, this.value === null ? null : text);
    this.handle.setAttribute("aria-valuenow", String(this.value ?? start));
  }

  private move(wanted: number | null): void {
    this.set(wanted);
    tellView(this.handle);
  }
}

/** Of the map's right side and of its lower one. */
export class Borders implements Linked {
  private readonly all: Border[];

  constructor(view: HTMLElement) {
    this.all = borders.map((how) => new Border(view, how));
  }

  get handles(): HTMLElement[] {
    return this.all.map(({ handle }) => handle);
  }

  state(): Record<string, string> {
    return Object.fromEntries(this.all.flatMap(({ how, state }) => (state === null ? [] : [[how.key, String(state)]])));
  }

  setState(said: URLSearchParams): void {
    for (const border of this.all) {
      const value = Number.parseFloat(said.get(border.how.key) ?? "");
      border.set(Number.isFinite(value) ? value : null);
    }
  }
}

/** Shows the map and the slider alone, on the whole screen where the browser allows that, or else in the whole window. */
export class FullScreen {
  private isNative = false;
  /** What the browser was asked for, and has not done yet. */
  private isPending = false;

  constructor(private readonly view: HTMLElement) {
    document.addEventListener("fullscreenchange", () => {
      const was = this.isNative;
      this.isNative = document.fullscreenElement === view;
      // The browser has its own keys to leave the whole screen.
      if (was && !this.isNative && !this.isPending) view.classList.remove("full");
    });
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.isOn) this.toggle();
    });
  }

  private get isOn(): boolean {
    return this.view.classList.contains("full");
  }

  toggle(): void {
    this.view.classList.toggle("full");
    void this.follow();
  }

  /** The browser takes its time, in which the reader may want something else again: one after the other. */
  private async follow(): Promise<void> {
    if (this.isPending) return;
    this.isPending = true;
    try {
      for (let asked: boolean | null = null; asked !== this.isOn; ) {
        asked = this.isOn;
        if (asked === (document.fullscreenElement === this.view)) continue;
        await (asked ? this.view.requestFullscreen() : document.exitFullscreen());
      }
    } catch {
      // Pages within other pages may not have the whole screen.
    }
    this.isPending = false;
  }
}

/** A trial of one step has nothing to slide over, and no curves. */
export function followLength(view: HTMLElement, store: Store): void {
  const follow = (): void => void view.classList.toggle("one-step", store.steps?.step.length === 1);
  store.subscribe((change) => change.trial && follow());
  follow();
}
