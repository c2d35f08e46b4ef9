// The choice of light or dark, before anything is painted: a script of its own, no module.
(() => {
  const stored = () => {
    try { return localStorage.getItem('theme'); } catch { return null; }
  };
  const root = document.documentElement;
  const take = (theme) => {
    if (theme === 'light' || theme === 'dark') root.dataset.theme = theme;
    else delete root.dataset.theme;
    dispatchEvent(new Event('themechange'));
  };
  take(stored());
  addEventListener('DOMContentLoaded', () => {
    const choice = document.getElementById('theme');
    choice.value = root.dataset.theme ?? 'auto';
    choice.addEventListener('change', () => {
      try { localStorage.setItem('theme', choice.value); } catch { /* A page without storage forgets it. */ }
      take(choice.value);
    });
  });
})();
