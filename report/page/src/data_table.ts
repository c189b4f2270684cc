// Tables that fit: what there is no room for is told below a row when it is asked for, and many rows are shown when they are.
import { el, replace, type Child } from "./elements";
import { csvButtonOf } from "./export";
import { count } from "./numbers";
import { explained, withMeaning } from "./words";

/** Columns are left out from the last one on, until the table is no wider than its place; never the first of them. */
export class FittedTable {
  readonly element: HTMLElement;
  private readonly table: HTMLTableElement;
  private width = 0;

  /** `keys` columns are always shown. */
  constructor(
    private readonly head: HTMLTableRowElement,
    private readonly body: HTMLTableSectionElement,
    private readonly keys: number,
    className: string,
    ...below: Child[]
  ) {
    this.table = el("table", { class: `fitted ${className}` }, el("thead", {}, head), body);
    this.element = el("div", { class: "table" }, this.table, ...below);
    body.addEventListener("click", (event) => this.unfold(event));
    new ResizeObserver(() => {
      if (this.element.clientWidth !== this.width) this.fit();
    }).observe(this.element);
  }

  fit(): void {
    this.width = this.element.clientWidth;
    if (this.width === 0) return;
    const { cells } = this.head;
    for (let shown = cells.length; ; --shown) {
      this.table.dataset.columns = shown < cells.length ? String(shown) : "all";
      if (shown <= this.keys || this.table.offsetWidth <= this.width) break;
    }
    for (const detail of this.body.querySelectorAll("tr.unfolded")) detail.remove();
    for (const button of this.body.querySelectorAll(".unfold")) button.setAttribute("aria-expanded", "false");
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
}

/** A row of a fitted table; its first cell names it. */
export function fittedRow(name: Child, cells: Child[], attributes: Record<string, string | number> = {}): HTMLTableRowElement {
  const unfold = el("button", { type: "button", class: "unfold", "aria-expanded": "false", "aria-label": "All of this row" });
  return el("tr", attributes, el("th", { scope: "row" }, name, unfold), ...cells.map((cell) => el("td", {}, cell)));
}

/** A word in a table tells what it means. */
function told(cell: Child): Child {
  return typeof cell === "string" ? explained(el("span", {}, cell)) : cell;
}

export function headRow(head: Child[]): HTMLTableRowElement {
  return el("tr", {}, ...head.map((cell) => (cell === "" ? el("td") : el("th", { scope: "col" }, told(cell)))));
}

/** A table whose first column names the rows, and which can be saved. Cells may be elements; the first `keys` columns are always shown. "facts" are names and values, one below the other where there is little room. */
export function table(head: Child[], rows: Child[][], keys: number, className = ""): HTMLElement {
  const body = el("tbody", {}, ...rows.map(([name, ...cells]) => fittedRow(name, cells)));
  const all = [headRow(head), ...body.rows];
  const texts = (): string[][] => all.map((row) => [...row.cells].map((cell) => (cell.textContent ?? "").trim()));
  const csv: HTMLElement = csvButtonOf(() => csv.closest("[data-table]")?.getAttribute("data-table") ?? csv.closest("section")?.id ?? "table", texts);
  return new FittedTable(all[0], body, keys, className, csv).element;
}

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

export interface TableOptions<Row> {
  /** So many columns are always shown. */
  keys: number;
  /** More rows are shown when they are asked for. */
  most: number;
  what: string;
  className?: string;
  attributes?: (row: Row) => Record<string, string | number>;
}

/** Sorted by a click on the head of a column: the best first, and then the other way round. */
export class DataTable<Row> {
  readonly element: HTMLElement;
  private readonly body = el("tbody", {});
  private readonly rest = el("p", { class: "note" });
  private readonly fitted: FittedTable;
  private readonly heads: HTMLElement[];
  private rows: Row[] = [];
  private sorted: { column: Column<Row>; isReversed: boolean } | null = null;
  private hasAll = false;
  private atLeast = 0;

  constructor(
    private readonly columns: Column<Row>[],
    private readonly options: TableOptions<Row>,
  ) {
    this.heads = columns.map((column) => el("th", { scope: "col" }, this.headOf(column)));
    const csv = csvButtonOf(() => options.what, () => this.texts());
    this.fitted = new FittedTable(el("tr", {}, ...this.heads), this.body, options.keys, options.className ?? "", this.rest, csv);
    this.element = this.fitted.element;
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
    const value = (row: Row): number | string | null => order.by(row) ?? null;
    return [...this.rows].sort((a, b) => {
      const [x, y] = [value(a), value(b)];
      if (x === null || y === null) return Number(x === null) - Number(y === null);
      const difference = typeof x === "number" && typeof y === "number" ? x - y : String(x).localeCompare(String(y), "en", { numeric: true });
      return sign * difference;
    });
  }

  private fill(): void {
    const rows = this.ordered();
    const some = this.hasAll ? rows : rows.slice(0, Math.max(this.options.most, this.atLeast));
    const [name, ...others] = this.columns;
    const rowOf = (row: Row): HTMLElement => {
      const element = fittedRow(name.cell(row), others.map((column) => column.cell(row)), this.options.attributes?.(row));
      others.forEach(({ kind }, i) => kind && element.cells[i + 1].classList.add(...kind(row).split(" ").filter(Boolean)));
      return element;
    };
    replace(this.body, ...some.map(rowOf));
    this.heads.forEach((head, i) => {
      const isSorted = this.sorted?.column === this.columns[i];
      const isDown = (this.columns[i].order?.best === "most") !== this.sorted?.isReversed;
      if (isSorted) head.setAttribute("aria-sort", isDown ? "descending" : "ascending");
      else head.removeAttribute("aria-sort");
    });
    const all = el("button", { type: "button", class: "all", click: () => this.showAll() }, `all ${count(rows.length)} ${this.options.what}`);
    replace(this.rest, some.length < rows.length && `The first ${count(some.length)}. `, some.length < rows.length && all);
    this.fitted.fit();
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
