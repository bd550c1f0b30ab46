"use strict";
const all = (query, within = document) => [...within.querySelectorAll(query)];
const rows = all(".finding");
const bar = document.querySelector("#filters");
const controls = all("select, input", bar);
const drawn = all("svg.graph .n, svg.graph .t, svg.tree .f");
const edges = all("[data-e]");

function filter() {
  const [level, robot, typed] = controls.map((control) => control.value);
  const text = typed.trim().toLowerCase();
  const ofRobot = (part) => !robot || part.dataset.robot.split(" ").includes(robot);
  const named = (part) => !text || part.textContent.toLowerCase().includes(text);
  for (const row of rows) {
    row.hidden = !(ofRobot(row) && named(row) && (!level || row.dataset.level === level));
  }
  for (const card of all(".card")) card.hidden = !ofRobot(card);
  const kept = keep(text, named);
  for (const group of all(".group")) {
    const found = !text || drawn.some((part) => kept.has(part) && group.contains(part));
    group.hidden = !(ofRobot(group) && found);
    if (text && found && kept.size < 60) reveal(group);
  }
  const shown = rows.filter((row) => !row.hidden).length;
  bar.querySelector("output").textContent = rows.length ? `${shown} of ${rows.length} rows` : "";
}

// Dims what neither has the text nor is connected to it; returns the parts that have it.
function keep(text, named) {
  const kept = new Set(drawn.filter((part) => text && named(part)));
  const ids = new Set([...kept].map((part) => part.dataset.id));
  const near = new Set(ids);
  for (const edge of edges) {
    const ends = edge.dataset.e.split(" ");
    const joined = !text || ends.some((id) => id && ids.has(id));
    edge.classList.toggle("off", !joined);
    if (joined) ends.forEach((id) => near.add(id));
  }
  for (const part of drawn) part.classList.toggle("off", !!text && !kept.has(part) && !near.has(part.dataset.id));
  return kept;
}

function clear() {
  for (const part of all(".hit, .finding.picked")) part.classList.remove("hit", "picked");
  document.body.classList.remove("picked");
}

// Highlights these elements wherever they are drawn, and their edges; for one element all its edges.
function mark(ids) {
  clear();
  const wanted = new Set(ids);
  if (!wanted.size) return;
  for (const part of all("[data-id]")) part.classList.toggle("hit", wanted.has(part.dataset.id));
  for (const edge of edges) {
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

function go(hash) {
  const place = document.querySelector(hash);
  if (!place) return;
  place.hidden = false;
  reveal(place);
  place.scrollIntoView({ block: "center", inline: "center" });
}

function pick(row) {
  mark(row.dataset.hits.split(" ").filter(Boolean));
  row.classList.add("picked");
}

for (const row of rows) {
  row.querySelector("summary").addEventListener("click", (event) => {
    if (!event.target.closest("a")) pick(row);
  });
}
for (const link of all('a[href^="#"]')) {
  link.addEventListener("click", (event) => {
    event.preventDefault();
    const row = document.querySelector(`${link.hash}.finding`) || link.closest(".finding");
    if (row && !link.matches(".rule")) pick(row);
    go(link.hash);
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
for (const kind of ["input", "change"]) bar.addEventListener(kind, filter);
bar.hidden = false;
filter();
