// SPDX-License-Identifier: MIT
// Named layouts: the list, save, load, delete.

import * as api from './api.js';
import { get, keyed, make, setText } from './dom.js';

export class Layouts {
  #run; #may = false;

  /** `run(action, done)`: awaits the action, announces done(result) or says what went wrong. */
  constructor(run) {
    this.#run = run;
    get('save').addEventListener('click', () => this.#save());
    get('layout-name').addEventListener('keydown', ({ key }) => key === 'Enter' && this.#save());
  }

  /** `may`: save, load and delete. */
  async refresh(may) {
    this.#may = may;
    get('save-layout').hidden = !may;
    setText(get('no-layouts'), '');
    const names = await api.getLayouts().catch(error => {
      setText(get('no-layouts'), error.message);
      return [];
    });
    keyed(get('layouts'), names, name => name, name => this.#makeRow(name),
        row => row.querySelectorAll('button').forEach(button => { button.disabled = !may; }));
  }

  #save() {
    const name = get('layout-name').value.trim();
    if (name) this.#change(() => api.saveLayout(name), () => `Layout ${name} is saved`);
  }
  #makeRow(name) {
    const button = (text, action, done) => {
      const element = make('button', { type: 'button', textContent: text, onclick: () => this.#change(action, done) });
      element.setAttribute('aria-label', `${text} layout ${name}`);
      return element;
    };
    const row = make('li', {}, make('span'),
      button('Load', () => api.loadLayout(name), ({ placed, waiting }) =>
          `Layout ${name}: ${placed} windows placed, ${waiting} places wait for theirs`),
      button('Delete', () => api.deleteLayout(name), () => `Layout ${name} is deleted`));
    setText(row.firstChild, name);
    return row;
  }
  async #change(action, done) {
    await this.#run(action, done);
    await this.refresh(this.#may);
  }
}
