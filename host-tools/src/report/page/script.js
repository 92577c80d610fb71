// Sorts a table by the column whose header is chosen. `#sort=ID,COLUMN` in the address does the same, and `,down` after it
// turns the order round. Without this script all is there but in the order of the report.
"use strict";
(() => {
  const sort = (table, column, down) => {
    const headers = table.tHead.rows[0].cells;
    const body = table.tBodies[0];
    const numeric = headers[column].classList.contains("number");
    const key = (row) => {
      const cell = row.cells[column];
      if (!numeric) return cell.textContent;
      return cell.dataset.value === undefined ? NaN : parseFloat(cell.dataset.value.replace("inf", "Infinity"));
    };
    const compare = (a, b) => (a < b ? -1 : a > b ? 1 : 0);
    const rows = Array.from(body.rows, (row) => [key(row), row]);
    // What has no value stays last in both orders; equal rows stay as they were.
    const has = ([value]) => !numeric || !Number.isNaN(value);
    const sorted = rows.filter(has).sort((a, b) => (down ? -1 : 1) * compare(a[0], b[0]));
    for (const [, row] of sorted.concat(rows.filter((row) => !has(row)))) body.appendChild(row);
    for (const header of headers) header.removeAttribute("aria-sort");
    headers[column].setAttribute("aria-sort", down ? "descending" : "ascending");
  };
  for (const table of document.querySelectorAll("table.sortable")) {
    Array.from(table.tHead.rows[0].cells, (header, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...header.childNodes);
      button.addEventListener("click", () => {
        const down = header.getAttribute("aria-sort") === "ascending";
        history.replaceState(null, "", `#sort=${table.id},${column}${down ? ",down" : ""}`);
        sort(table, column, down);
      });
      header.append(button);
    });
  }
  const follow = () => {
    const wanted = /^#sort=([\w-]+),(\d+)(,down)?$/.exec(location.hash);
    const table = wanted && document.getElementById(wanted[1]);
    if (!table || Number(wanted[2]) >= table.tHead.rows[0].cells.length) return;
    sort(table, Number(wanted[2]), wanted[3] !== undefined);
    table.scrollIntoView();
  };
  addEventListener("hashchange", follow);
  follow();
})();
