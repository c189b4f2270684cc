// Parts of the page of which its address tells.

export interface Linked {
  /** What a link to what it shows says of it; nothing of what is as on a page that was just opened. */
  state(): Record<string, string>;
  /** What is not said is as on a page that was just opened. */
  setState(said: URLSearchParams): void;
}

/** To be told where such a part shows something else. */
export function tellView(element: HTMLElement): void {
  element.dispatchEvent(new Event("viewchange", { bubbles: true }));
}
