// SPDX-License-Identifier: MIT
// Small helpers for the document.

export const get = id => document.getElementById(id);

export function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** Without touching what is right already: screen readers and selections stay calm. */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** One child of `parent` per item, kept as long as its key is there, so that the focus stays where it is. */
export function keyed(parent, items, keyOf, create, update) {
  const old = new Map([...parent.children].map(child => [child.dataset.key, child]));
  items.forEach((item, i) => {
    const key = String(keyOf(item));
    const element = old.get(key) ?? create(item);
    element.dataset.key = key;
    old.delete(key);
    update(element, item);
    if (parent.children[i] !== element) parent.insertBefore(element, parent.children[i] ?? null);
  });
  old.forEach(element => element.remove());
}

/**
 * Table rows: `columns` are functions from an item to text, or to {text, state, title}. The first cell heads the row;
 * with `onHead` it is a button.
 */
export function rows(body, items, keyOf, columns, onHead) {
  const head = item => make('th', { scope: 'row' }, ...onHead
      ? [make('button', { type: 'button', onclick: () => onHead(keyOf(item)) })] : []);
  const create = item => make('tr', {}, head(item), ...columns.slice(1).map(() => make('td')));
  keyed(body, items, keyOf, create, (row, item) => columns.forEach((column, i) => {
    const value = column(item), cell = row.cells[i];
    setText(cell.firstElementChild ?? cell, value.text ?? value);
    if (value.state) cell.dataset.state = value.state;
    if (value.title && cell.title !== value.title) cell.title = value.title;
  }));
}
