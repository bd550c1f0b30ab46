// Each drawing is larger or smaller by buttons or Ctrl and the wheel, and moved by dragging.
function zoomed(pane, factor) {
  const svg = pane.querySelector("svg");
  const old = svg.getBoundingClientRect().width;
  const middle = (pane.scrollLeft + pane.clientWidth / 2) / old;
  const wide = factor ? Math.min(Math.max(old * factor, 200), 8000) : 0;
  pane.classList.toggle("zoomed", Boolean(wide));
  svg.style.minWidth = wide ? "0" : "";
  svg.style.maxWidth = wide ? "none" : "";
  svg.style.width = wide ? `${wide}px` : "";
  svg.style.height = wide ? "auto" : "";
  pane.scrollLeft = middle * (wide || svg.getBoundingClientRect().width) - pane.clientWidth / 2;
}

function buttons(pane) {
  const bar = document.createElement("span");
  bar.className = "zoom";
  const ways = [["+", "larger", 1.3], ["−", "smaller", 1 / 1.3], ["fit", "as it was", 0]];
  for (const [sign, words, factor] of ways) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = sign;
    button.title = words;
    button.addEventListener("click", () => zoomed(pane, factor));
    bar.append(button);
  }
  pane.parentElement.append(bar);
}

function draggable(pane) {
  pane.addEventListener("wheel", (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoomed(pane, event.deltaY < 0 ? 1.15 : 1 / 1.15);
  }, { passive: false });
  pane.addEventListener("pointermove", (event) => {
    if (event.buttons !== 1 || event.pointerType !== "mouse") return;
    pane.scrollLeft -= event.movementX;
    pane.scrollTop -= event.movementY;
  });
}

for (const pane of all(".pane")) {
  buttons(pane);
  draggable(pane);
}
