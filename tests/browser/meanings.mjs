// What the tables of a page say of their columns.
import assert from "node:assert/strict";

/** Every column tells what it is, and so do the numbers of the step, the layers of maps, and every row of the summary. */
export async function assertTablesExplained(page, fewest) {
  const heads = await page.locator("table").evaluateAll((tables) => {
    const isTold = (cell) => cell.matches("[data-meaning], [title]") || cell.querySelector("[data-meaning], [title]") !== null;
    const place = (cell) => `${cell.closest("section, #view, figure")?.id}: ${cell.textContent}`;
    const told = (cells) => cells.filter((cell) => cell.textContent !== "").map((cell) => ({ place: place(cell), isTold: isTold(cell) }));
    const ofStep = told([...document.querySelectorAll(".details dt, .legend label:has([data-layer], [data-space-layer])")]);
    const ofTables = tables.flatMap((table) => told([...table.querySelectorAll(table.closest("#summary") ? "tbody th" : "thead th")]));
    return [...ofStep, ...ofTables];
  });
  assert.deepEqual(heads.filter(({ isTold }) => !isTold).map(({ place }) => place), []);
  assert.ok(heads.length >= fewest, `${heads.length} heads`);
}
