// SPDX-License-Identifier: GPL-3.0-or-later
// Tables are sorted by the column whose head is clicked, a second time the other way.
"use strict";

/** What a cell is sorted by: its number if it has one, else its text; empty cells come last. */
function sortKey(cell) {
  const text = cell.textContent.trim(), number = parseFloat(text);
  if (!Number.isNaN(number)) return [0, number];
  return [text === "" || text === "–" ? 2 : 1, text];
}

function sortBy(head) {
  const row = head.parentElement, table = head.closest("table"), column = head.cellIndex;
  const down = head.ariaSort === "ascending";
  for (const other of row.cells) other.ariaSort = other === head ? (down ? "descending" : "ascending") : null;
  const compare = ([kindA, a], [kindB, b]) =>
    kindA - kindB || (a < b ? -1 : a > b ? 1 : 0) * (down ? -1 : 1);
  const rows = [...table.tBodies[0].rows].map((one) => [sortKey(one.cells[column]), one]);
  rows.sort(([a], [b]) => compare(a, b));
  table.tBodies[0].append(...rows.map(([, one]) => one));
}

function makeSortable() {
  for (const head of document.querySelectorAll(".sorts thead th")) {
    head.tabIndex = 0;
    head.addEventListener("click", () => sortBy(head));
    head.addEventListener("keydown", (event) => { if (event.key === "Enter") sortBy(head); });
  }
}
