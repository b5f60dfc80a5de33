// SPDX-License-Identifier: MIT
// Loads the page again if a part of its program did not come: a laptop that changes its network just then. main.js says
// when all of it is there. A script of its own, and no module, since no module would run.

(() => {
  const kTries = 'wallgl-tries', kFirstWait = 1000, kMostWait = 30000;  // ms

  addEventListener('error', ({ target }) => {
    if (target?.tagName !== 'SCRIPT') return;
    const tries = Number(sessionStorage.getItem(kTries)), wait = Math.min(kFirstWait * 2 ** tries, kMostWait);
    sessionStorage.setItem(kTries, Math.min(tries + 1, 10));
    const connection = document.getElementById('connection');
    if (connection) {
      connection.dataset.state = 'lost';
      connection.textContent = `the page did not come as a whole; it is loaded again in ${Math.round(wait / 1000)} s`;
    }
    setTimeout(() => location.reload(), wait);
  }, true);
  addEventListener('wallgl-started', () => sessionStorage.removeItem(kTries));
})();
