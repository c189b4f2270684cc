// What the tables of a page say of their columns.
import assert from "node:assert/strict";

/** Every column tells what it is, and so do the numbers of the step and the layers of maps; where columns are runs, every row of the summary does. */
export async function assertTablesExplained(page, fewest) {
  const heads = await page.locator("table").evaluateAll((tables) => {
    const runs = [document.body.dataset.run, ...[...document.querySelectorAll("#run option")].map((option) => option.textContent)];
    const isTold = (cell) => cell.matches("[data-meaning], [title]") || cell.querySelector("[data-meaning], [title]") !== null;
    const place = (cell) => `${cell.closest("section, #view, figure")?.id}: ${cell.textContent}`;
    const told = (cells) => cells.filter((cell) => cell.textContent !== "").map((cell) => ({ place: place(cell), isTold: isTold(cell) }));
    const ofStep = told([...document.querySelectorAll(".details dt, .legend label:has([data-layer], [data-space-layer])")]);
    const ofTables = tables.flatMap((table) => {
      const columns = [...table.querySelectorAll("thead th")];
      const ofRuns = columns.length > 0 && columns.every((cell) => runs.includes(cell.textContent));
      if (!ofRuns) return told(columns);
      return table.closest("#summary") ? told([...table.querySelectorAll("tbody th")]) : [];
    });
    return [...ofStep, ...ofTables];
  });
  assert.deepEqual(heads.filter(({ isTold }) => !isTold).map(({ place }) => place), []);
  assert.ok(heads.length >= fewest, `${heads.length} heads`);
}
