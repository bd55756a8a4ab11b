// ---- one submission -------------------------------------------------------------------------------

viewer.toggle("boxes", false);
viewer.show(one("#_submission"));
const does = {
  "[": () => viewer.split(-2), "]": () => viewer.split(2), ",": () => viewer.gain(-1), ".": () => viewer.gain(1),
  "+": () => viewer.nearer(1), "=": () => viewer.nearer(1), "-": () => viewer.nearer(-1), 0: () => viewer.whole(),
  l: () => viewer.toggle("loupe"), t: () => theme.click(),
  1: () => viewer.choose(0), 2: () => viewer.choose(1), 3: () => viewer.choose(2), 4: () => viewer.choose(3),
};
const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing) return;
  const focus = document.activeElement;
  let used = true;
  if (focus === viewer.stage && event.key in arrows) viewer.move(...arrows[event.key].map((v) => v * (event.shiftKey ? 10 : 1)));
  else if (event.key === "Escape" && viewer.zoomed) viewer.whole();
  else if (event.key === " " && viewer.blinks && !focus.matches("button, a, summary, input")) viewer.space();
  else if (Object.hasOwn(does, event.key)) does[event.key]();
  else used = false;
  if (used) event.preventDefault();
});
