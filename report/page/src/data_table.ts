// Tables that fit: what there is no room for is told below a row when it is asked for, and many rows are shown when they are.
import { el, replace, type Child } from "./elements";
import { csvButtonOf } from "./export";
import { count } from "./numbers";
import { explained, withMeaning } from "./words";

export interface Column<Row> {
  name: string;
  /** What it means, where the name alone does not say it. */
  word?: string;
  meaning?: string;
  cell: (row: Row) => Child;
  /** What rows are sorted by, and whether more is better; nothing is last. Absent where sorting says nothing. */
  order?: { by: (row: Row) => number | string | null | undefined; best: "least" | "most" };
  /** Of the cells, for the style sheet. */
  kind?: (row: Row) => string;
}

interface TableOptions {
  /** So many columns are always shown. */
  keys: number;
  /** More rows are shown when they are asked for; without it all are. */
  most?: number;
  what: string;
  className?: string;
}

/**
 * Columns are left out from the last one on, until the table is no wider than its place; never the first of them. Sorted by a click on
 * the head of a column: the best first, and then the other way round.
 */
export class DataTable<Row> {
  readonly element: HTMLElement;
  private readonly body = el("tbody", {});
  private readonly rest = el("p", { class: "note" });
  private readonly head: HTMLTableRowElement;
  private readonly table: HTMLTableElement;
  private width = 0;
  private rows: Row[] = [];
  private sorted: { column: Column<Row>; isReversed: boolean } | null = null;
  private hasAll = false;
  private atLeast = 0;

  constructor(
    private readonly columns: Column<Row>[],
    private readonly options: TableOptions,
  ) {
    const { what, most, className = "" } = options;
    // A head without any name is left out by the style sheet.
    const heads = columns.map((column) => (column.name === "" ? el("td") : el("th", { scope: "col" }, this.headOf(column))));
    this.head = el("tr", {}, ...heads);
    this.table = el("table", { class: `fitted ${className}` }, el("thead", {}, this.head), this.body);
    this.element = el("div", { class: "table" }, this.table, most !== undefined && this.rest, csvButtonOf(() => what, () => this.texts()));
    this.body.addEventListener("click", (event) => this.unfold(event));
    new ResizeObserver(() => {
      if (this.element.clientWidth !== this.width) this.fit();
    }).observe(this.element);
  }

  /** Shows at least so many of them. */
  setRows(rows: Row[], atLeast = 0): void {
    this.rows = rows;
    this.atLeast = atLeast;
    this.fill();
  }

  /** The rows that are shown, with what they are of. */
  get shown(): [HTMLTableRowElement, Row][] {
    const rows = this.ordered();
    return [...this.body.querySelectorAll<HTMLTableRowElement>("tr:not(.unfolded)")].map((row, i) => [row, rows[i]]);
  }

  private headOf(column: Column<Row>): Child {
    const { name, word = name, meaning, order } = column;
    const text = order
      ? el("button", { type: "button", class: "sort", "data-sort": name, click: () => this.sort(column) }, name)
      : el("span", {}, name);
    return meaning === undefined ? explained(text, word) : withMeaning(text, meaning);
  }

  private sort(column: Column<Row>): void {
    const isSame = this.sorted?.column === column;
    if (isSame && this.sorted?.isReversed) this.sorted = null;
    else this.sorted = { column, isReversed: isSame };
    this.fill();
  }

  private ordered(): Row[] {
    const order = this.sorted?.column.order;
    if (!order || !this.sorted) return this.rows;
    const sign = (order.best === "most") === this.sorted.isReversed ? 1 : -1;
    // A share of nothing is no number, and is last as nothing is.
    const value = (row: Row): number | string | null => {
      const its = order.by(row) ?? null;
      return typeof its === "number" && !Number.isFinite(its) ? null : its;
    };
    return [...this.rows].sort((a, b) => {
      const [x, y] = [value(a), value(b)];
      if (x === null || y === null) return Number(x === null) - Number(y === null);
      const difference = typeof x === "number" && typeof y === "number" ? x - y : String(x).localeCompare(String(y), "en", { numeric: true });
      return sign * difference;
    });
  }

  private fill(): void {
    const rows = this.ordered();
    const some = this.hasAll ? rows : rows.slice(0, Math.max(this.options.most ?? Infinity, this.atLeast));
    const [name, ...others] = this.columns;
    const rowOf = (row: Row): HTMLElement => {
      const unfold = el("button", { type: "button", class: "unfold", "aria-expanded": "false", "aria-label": "All of this row" });
      const cells = others.map(({ cell, kind }) => el("td", { class: kind?.(row) }, cell(row)));
      return el("tr", {}, el("th", { scope: "row" }, name.cell(row), unfold), ...cells);
    };
    // Rows that the reader has unfolded stay so where they are made anew.
    const nameOf = (button: Element): string | undefined => button.closest("th")?.textContent ?? undefined;
    const unfolded = [...this.body.querySelectorAll('.unfold[aria-expanded="true"]')].map(nameOf);
    replace(this.body, ...some.map(rowOf));
    [...this.head.cells].forEach((head, i) => {
      const isSorted = this.sorted?.column === this.columns[i];
      const isDown = (this.columns[i].order?.best === "most") !== this.sorted?.isReversed;
      if (isSorted) head.setAttribute("aria-sort", isDown ? "descending" : "ascending");
      else head.removeAttribute("aria-sort");
    });
    const all = el("button", { type: "button", class: "all", click: () => this.showAll() }, `all ${count(rows.length)} ${this.options.what}`);
    replace(this.rest, some.length < rows.length && `The first ${count(some.length)}. `, some.length < rows.length && all);
    this.fit();
    if (unfolded.length === 0 || this.table.dataset.columns === "all") return;
    for (const button of this.body.querySelectorAll<HTMLElement>(".unfold")) if (unfolded.includes(nameOf(button))) button.click();
  }

  private fit(): void {
    this.width = this.element.clientWidth;
    if (this.width === 0) return;
    for (const detail of this.body.querySelectorAll("tr.unfolded")) detail.remove();
    for (const button of this.body.querySelectorAll(".unfold")) button.setAttribute("aria-expanded", "false");
    const rows = [...this.table.rows];
    for (const row of rows) for (const cell of row.cells) cell.hidden = false;
    this.table.dataset.columns = "all";
    for (let last = this.columns.length - 1; last >= this.options.keys && this.table.offsetWidth > this.width; --last) {
      for (const row of rows) row.cells[last].hidden = true;
      // With fewer than all, rows get the buttons that unfold them.
      this.table.dataset.columns = String(last);
    }
  }

  private unfold(event: Event): void {
    const button = event.target instanceof Element ? event.target.closest(".unfold") : null;
    const row = button?.closest("tr");
    if (!button || !row) return;
    const isOpen = button.getAttribute("aria-expanded") === "true";
    button.setAttribute("aria-expanded", String(!isOpen));
    if (isOpen) {
      row.nextElementSibling?.remove();
      return;
    }
    const first = Number(this.table.dataset.columns);
    const told = [...row.cells].slice(first).map((cell, i) =>
      el("div", {}, el("dt", {}, this.head.cells[first + i].textContent), el("dd", {}, ...[...cell.childNodes].map((node) => node.cloneNode(true)))),
    );
    row.after(el("tr", { class: "unfolded" }, el("td", { colspan: first }, el("dl", {}, ...told))));
  }

  private showAll(): void {
    this.hasAll = true;
    this.fill();
  }

  private texts(): string[][] {
    const text = (cell: Child): string => (cell instanceof Node ? (cell.textContent ?? "") : String(cell ?? "")).trim();
    return [this.columns.map(({ name }) => name), ...this.ordered().map((row) => this.columns.map((column) => text(column.cell(row))))];
  }
}

/** A table of rows as they are, whose first column names them. "facts" are names and values, one below the other where there is little room. */
export function table(what: string, head: string[], rows: Child[][], className?: string): HTMLElement {
  const columns = head.map((name, i): Column<Child[]> => ({ name, cell: (row) => row[i] }));
  const all = new DataTable(columns, { keys: 2, what, className });
  all.setRows(rows);
  return all.element;
}
