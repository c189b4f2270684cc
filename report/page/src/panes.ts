// How the parts of the view share the page: borders that can be moved, the map alone on the whole screen, and what a trial of one
// step needs not.
import { el } from "./elements";
import type { Store } from "./store";

interface Border {
  name: string;
  orientation: "vertical" | "horizontal";
  /** Of what the border sets: percent of the width, or px. */
  least: number;
  most: number;
  start: number;
  step: number;
  /** From where the pointer is. */
  valueAt: (event: PointerEvent, view: HTMLElement) => number;
  set: (view: HTMLElement, value: number) => void;
}

const borders: Border[] = [
  {
    name: "Width of the map",
    orientation: "vertical",
    least: 20,
    most: 80,
    start: 46,
    step: 2,
    valueAt: (event, view) => {
      const { left, width } = view.getBoundingClientRect();
      return (100 * (event.clientX - left)) / width;
    },
    set: (view, value) => {
      view.style.setProperty("--map-width", `${value}fr`);
      view.style.setProperty("--curves-width", `${100 - value}fr`);
    },
  },
  {
    name: "Height of the map",
    orientation: "horizontal",
    least: 200,
    most: 2000,
    start: 560,
    step: 20,
    valueAt: (event, view) => event.clientY - (view.querySelector(".stage")?.getBoundingClientRect().top ?? 0) - 10,
    set: (view, value) => view.style.setProperty("--map-height", `${value}px`),
  },
];

/** What moves a border, by pointer or by arrow keys; a double click puts it where it was. */
function border(view: () => HTMLElement, how: Border): HTMLElement {
  let value = how.start;
  const set = (wanted: number): void => {
    value = Math.round(Math.min(Math.max(wanted, how.least), how.most));
    how.set(view(), value);
    handle.setAttribute("aria-valuenow", String(value));
  };
  const isAcross = how.orientation === "vertical";
  const keys: Record<string, number> = isAcross ? { ArrowLeft: -1, ArrowRight: 1 } : { ArrowUp: -1, ArrowDown: 1 };
  const handle = el("div", {
    class: `border ${how.orientation}`,
    role: "separator",
    tabindex: 0,
    title: `${how.name}: drag, or arrow keys`,
    "aria-label": how.name,
    "aria-orientation": how.orientation,
    "aria-valuemin": how.least,
    "aria-valuemax": how.most,
    "aria-valuenow": value,
    dblclick: () => set(how.start),
  });
  handle.addEventListener("pointerdown", (event) => {
    handle.setPointerCapture(event.pointerId);
    event.preventDefault();
    handle.focus();
  });
  handle.addEventListener("pointermove", (event) => {
    if (handle.hasPointerCapture(event.pointerId)) set(how.valueAt(event, view()));
  });
  handle.addEventListener("keydown", (event) => {
    const direction = keys[event.key];
    if (direction === undefined) return;
    event.preventDefault();
    set(value + direction * how.step);
  });
  return handle;
}

/** Of the map's right side and of its lower one. */
export function bordersOf(view: () => HTMLElement): HTMLElement[] {
  return borders.map((how) => border(view, how));
}

/** Shows the map and the slider alone, on the whole screen where the browser allows that, or else in the whole window. */
export class FullScreen {
  private isNative = false;

  constructor(private readonly view: HTMLElement) {
    document.addEventListener("fullscreenchange", () => {
      const was = this.isNative;
      this.isNative = document.fullscreenElement === view;
      if (was && !this.isNative) view.classList.remove("full");
    });
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.isOn) this.toggle();
    });
  }

  private get isOn(): boolean {
    return this.view.classList.contains("full");
  }

  toggle(): void {
    if (this.isOn) {
      this.view.classList.remove("full");
      if (this.isNative) void document.exitFullscreen();
      return;
    }
    this.view.classList.add("full");
    // Pages within other pages may not have the whole screen.
    this.view.requestFullscreen?.().catch(() => undefined);
  }
}

/** A trial of one step has nothing to slide over, and no curves. */
export function followLength(view: HTMLElement, store: Store): void {
  const follow = (): void => void view.classList.toggle("one-step", store.steps?.step.length === 1);
  store.subscribe((change) => change.trial && follow());
  follow();
}
