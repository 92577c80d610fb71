// What a test wants to know of a page that it has opened, as JSON in an element of its own.
addEventListener("load", () => {
  const all = (selector, within = document) => Array.from(within.querySelectorAll(selector));
  const tables = {};
  for (const table of all("table.sortable")) {
    tables[table.id] = {
      headers: all("th", table).map((header) => header.textContent),
      rows: all("tbody tr", table).map((row) => ({
        row: row.dataset.row === undefined ? null : Number(row.dataset.row),
        cells: all("td", row).map((cell) => cell.textContent),
      })),
    };
  }
  // What is chosen at first is the first of each.
  const chosen = (figure, kind) => !figure.closest(`.${kind}`) || figure.closest(`.${kind}-0`) !== null;
  const astray = all("figure").filter(
    (figure) => figure.checkVisibility() !== (chosen(figure, "scene") && chosen(figure, "metric")),
  ).length;
  // Positions are of what is shown.
  const style = document.createElement("style");
  style.textContent = ".scene, .metric { display: block !important }";
  document.head.append(style);
  for (const details of all("details")) details.open = true;
  const crowded = [];
  for (const svg of all("svg")) {
    const frame = svg.getBoundingClientRect();
    const boxes = all("text", svg).map((text) => [text.textContent.trim(), text.getBoundingClientRect()]);
    boxes.forEach(([name, box], index) => {
      if (box.width === 0) crowded.push(`${name} is not shown`);
      if (box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 1 || box.bottom > frame.bottom + 1)
        crowded.push(`${name} leaves ${svg.getAttribute("aria-label")}`);
      for (const [other, its] of boxes.slice(0, index)) {
        const across = Math.min(box.right, its.right) - Math.max(box.left, its.left);
        const down = Math.min(box.bottom, its.bottom) - Math.max(box.top, its.top);
        // Boxes are of lines, which are higher than what stands on them.
        if (across > 0.5 && down > 3) crowded.push(`${name} lies on ${other} in ${svg.getAttribute("aria-label")}`);
      }
    });
  }
  const found = {
    errors: window.probeErrors,
    crowded,
    astray,
    figures: all("figure").length,
    tables,
    text: document.body.innerText,
    elements: [...new Set(all("*").map((element) => element.tagName.toLowerCase()))],
    plots: all("svg").map((svg) => all("text", svg).map((text) => text.textContent.trim())),
    // A browser lists no file among what it loaded, so what is referred to counts too.
    loaded: all("[src], [srcset], [href], [data], [poster]")
      .flatMap((element) => ["src", "srcset", "href", "data", "poster"].map((name) => element.getAttribute(name)))
      .concat(performance.getEntriesByType("resource").map((entry) => entry.name))
      .filter((address) => address !== null && !/^(data:|#)/.test(address)),
    pictures: all("img").map((image) => image.complete && image.naturalWidth > 0),
    wide: document.documentElement.scrollWidth > document.documentElement.clientWidth,
  };
  const element = document.createElement("script");
  element.type = "application/json";
  element.id = "found";
  element.textContent = JSON.stringify(found).replaceAll("<", "\\u003c");
  document.body.append(element);
});
