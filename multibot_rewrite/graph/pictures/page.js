"use strict";
const all = (query, within = document) => [...within.querySelectorAll(query)];
const rows = all("#findings tbody tr");
const selects = all("#filters select");

function filter() {
  const [level, robot] = selects.map((select) => select.value);
  for (const row of rows) {
    const fits = (!level || row.dataset.level === level) &&
      (!robot || row.dataset.robot.split(" ").includes(robot));
    row.hidden = !fits;
  }
  const shown = rows.filter((row) => !row.hidden).length;
  document.querySelector("#filters output").textContent = `${shown} of ${rows.length}`;
}

function clear() {
  for (const part of all(".hit, tr.picked")) part.classList.remove("hit", "picked");
  document.body.classList.remove("picked");
}

// Highlights these elements wherever they are drawn, and their edges; for one element all its edges.
function mark(ids) {
  clear();
  const wanted = new Set(ids);
  if (!wanted.size) return;
  for (const part of all("[data-id]")) part.classList.toggle("hit", wanted.has(part.dataset.id));
  for (const edge of all("[data-e]")) {
    const ends = edge.dataset.e.split(" ").filter((id) => wanted.has(id));
    edge.classList.toggle("hit", ends.length === Math.min(wanted.size, 2));
  }
  document.body.classList.toggle("picked", all(".e.hit").length > 0);
}

function reveal(place) {
  for (let at = place; at; at = at.parentElement.closest("details")) {
    if (at.tagName === "DETAILS") at.open = true;
  }
}

function go(row) {
  const place = document.querySelector(row.querySelector("a.place").hash);
  mark(row.dataset.hits.split(" ").filter(Boolean));
  row.classList.add("picked");
  if (!place) return;
  reveal(place);
  place.scrollIntoView({ block: "center" });
}

for (const row of rows) {
  row.addEventListener("click", (event) => {
    const rule = event.target.closest("a.rule");
    if (rule) return reveal(document.querySelector(rule.hash));
    event.preventDefault();
    go(row);
  });
}
for (const part of all("svg.graph [data-id]")) {
  part.tabIndex = 0;
  part.addEventListener("click", () => mark([part.dataset.id]));
  part.addEventListener("keydown", (event) => {
    if (event.key === "Enter") mark([part.dataset.id]);
  });
}
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") clear();
});
for (const select of selects) select.addEventListener("change", filter);
if (rows.length) {
  document.querySelector("#filters").hidden = false;
  filter();
}
