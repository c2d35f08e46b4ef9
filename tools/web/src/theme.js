// The choice of light or dark, before anything is painted: a script of its own, no module.
(() => {
  const stored = () => {
    try { return localStorage.getItem('theme'); } catch { return null; }
  };
  const dark = matchMedia('(prefers-color-scheme: dark)');
  let chosen = stored();
  if (chosen !== 'light' && chosen !== 'dark') chosen = 'auto';
  const take = () => {
    document.documentElement.dataset.theme = chosen === 'auto' ? (dark.matches ? 'dark' : 'light') : chosen;
    dispatchEvent(new Event('themechange'));
  };
  take();
  dark.addEventListener('change', take);
  addEventListener('DOMContentLoaded', () => {
    const choice = document.getElementById('theme');
    choice.value = chosen;
    choice.addEventListener('change', () => {
      chosen = choice.value;
      try { localStorage.setItem('theme', chosen); } catch { /* A page without storage forgets it. */ }
      take();
    });
  });
})();
