// ---- light and dark -------------------------------------------------------------------------------

const theme = one("#_theme"), night = matchMedia("(prefers-color-scheme: dark)");
const isDark = () => (root.dataset.theme || (night.matches ? "dark" : "light")) === "dark";
const paint = () => theme.setAttribute("aria-pressed", String(isDark()));
theme.addEventListener("click", () => {
  root.dataset.theme = isDark() ? "light" : "dark";
  try { localStorage.setItem("lietool-theme", root.dataset.theme); } catch { /* it lasts as long as the page */ }
  paint();
});
night.addEventListener("change", paint);
paint();
