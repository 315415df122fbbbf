// Light and dark: the reader's choice, or else the system's. Charts ask here for their colours.
import { h } from './dom.js';

const KEY = 'quadrille-theme';
const listeners = [];
const system = window.matchMedia('(prefers-color-scheme: dark)');

function stored() {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null; // a page from a file may have no storage
  }
}

function store(theme) {
  try {
    localStorage.setItem(KEY, theme);
  } catch {
    // the choice then lasts as long as the page
  }
}

export const theme = () => document.documentElement.dataset.theme;

/** Calls back when the colours have changed. */
export const onTheme = (listener) => listeners.push(listener);

function set(name) {
  document.documentElement.dataset.theme = name;
  for (const listener of listeners) listener();
}

/** The value of a custom property of the style sheet. */
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

export function startTheme() {
  set(stored() ?? (system.matches ? 'dark' : 'light'));
  system.addEventListener('change', () => {
    if (!stored()) set(system.matches ? 'dark' : 'light');
  });
}

export function themeButton() {
  const text = () => (theme() === 'dark' ? 'Light' : 'Dark');
  const button = h('button', { type: 'button', id: 'theme', class: 'quiet', title: 'Light or dark colours (key T)' }, text());
  const toggle = () => {
    const next = theme() === 'dark' ? 'light' : 'dark';
    store(next);
    set(next);
    button.textContent = text();
  };
  button.addEventListener('click', toggle);
  document.addEventListener('keydown', (event) => {
    const typing = event.target.closest?.('input, select, textarea');
    if (event.key === 't' && !typing && !event.ctrlKey && !event.metaKey && !event.altKey) toggle();
  });
  return button;
}
