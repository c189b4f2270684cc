// What all pages share: that they draw the data that is in them, and their theme.
import { embeddedData } from "./chunks";
import { el, replace } from "./elements";

/** Light, dark, or as the system has it. */
export function themeButton(redraw: () => void): HTMLElement {
  const themes = ["auto", "light", "dark"] as const;
  const system = matchMedia("(prefers-color-scheme: dark)");
  const button = el("button", { type: "button" });
  let chosen = 0;
  const show = (): void => {
    const theme = themes[chosen];
    document.documentElement.dataset.theme = theme === "auto" ? (system.matches ? "dark" : "light") : theme;
    replace(button, `theme: ${theme}`);
  };
  const change = (): void => {
    show();
    redraw();
  };
  button.addEventListener("click", () => {
    chosen = (chosen + 1) % themes.length;
    change();
  });
  system.addEventListener("change", change);
  // Paper is white, whatever the screen is.
  window.addEventListener("beforeprint", () => {
    document.documentElement.dataset.theme = "light";
    redraw();
  });
  window.addEventListener("afterprint", change);
  show();
  return button;
}

/** Draws the data that is in the page, or says why it cannot. */
export function startPage<Data extends { format: number }>(show: (data: Data, page: HTMLElement) => void | Promise<void>): void {
  const page = document.getElementById("page");
  if (!page) return;
  void embeddedData<Data>()
    .then((data) => show(data, page))
    .catch((error) => {
      replace(page, el("p", { class: "warning", role: "alert" }, `The page cannot be shown: ${String(error)}`));
      throw error;
    });
}
