// Pictures and tables as files of their own.
import { el, replace } from "./elements";

const pixelsPerPixel = 2; // of PNG files

function slug(text: string): string {
  return text.trim().toLowerCase().replace(/[^\p{L}\p{N}.-]+/gu, "-").replace(/^-+|-+$/g, "");
}

/** Tells what is shown where `of` stands on the page: the run, and of single steps the trial and the step. */
function fileName(of: Element, what: string, ending: string): string {
  const { run, trial, step } = document.body.dataset;
  const parts: (string | undefined)[] = [];
  if (of.closest("#view, #trials")) parts.push(run && slug(run));
  if (of.closest("#view")) parts.push(trial && `trial-${trial}`, `step-${step}`);
  return `${[...parts, slug(what)].filter(Boolean).join("_")}.${ending}`;
}

export function save(name: string, content: Blob): void {
  const address = URL.createObjectURL(content);
  el("a", { href: address, download: name }).click();
  // The browser has taken it by then.
  window.setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** The picture of an SVG file, with two pixels for each of its own. */
async function pngOf(svg: string): Promise<Blob> {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
  await image.decode();
  const canvas = el("canvas", { width: image.width * pixelsPerPixel, height: image.height * pixelsPerPixel });
  canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the picture is too large for a PNG file"))), "image/png"),
  );
}

/** A menu that saves a picture, which `svg` draws when it is asked for. */
export function saveMenu(what: () => string, svg: () => string): HTMLElement {
  const button = (ending: string, content: () => Promise<Blob>): HTMLElement =>
    el(
      "button",
      {
        type: "button",
        "data-save": ending,
        click: () => void content().then(
          (blob) => {
            save(fileName(menu, what(), ending), blob);
            menu.open = false;
          },
          (error: unknown) => replace(fault, `No ${ending.toUpperCase()}: ${error instanceof Error ? error.message : error}.`),
        ),
      },
      ending.toUpperCase(),
    );
  const fault = el("p", { class: "warning", role: "alert" });
  const menu = el(
    "details",
    { class: "save", toggle: () => replace(fault) },
    el("summary", { title: "Save this picture", "aria-label": "Save this picture" }, "⤓"),
    button("svg", async () => new Blob([svg()], { type: "image/svg+xml" })),
    button("png", () => pngOf(svg())),
    fault,
  );
  return menu;
}

/** As RFC 4180 has it; numbers without the commas that people read them by, and nothing for what is missing. */
export function csvOf(rows: string[][]): string {
  const cell = (text: string): string => {
    const plain = /^-?\d{1,3}(,\d{3})+(\.\d+)?$/.test(text) ? text.replaceAll(",", "") : text === "–" ? "" : text;
    return /[",\r\n]/.test(plain) ? `"${plain.replaceAll('"', '""')}"` : plain;
  };
  return rows.map((row) => `${row.map(cell).join(",")}\r\n`).join("");
}

/** Saves rows that are asked for when they are wanted. */
export function csvButtonOf(what: () => string, rows: () => string[][]): HTMLElement {
  const button: HTMLElement = el(
    "button",
    {
      type: "button",
      class: "csv",
      title: "Save these numbers",
      click: () => save(fileName(button, what(), "csv"), new Blob([csvOf(rows())], { type: "text/csv" })),
    },
    "CSV",
  );
  return button;
}
