// Elements from code. Text is always text: nothing here reads HTML, so a name from a file can hold anything.

const SVG = 'http://www.w3.org/2000/svg';

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name === 'style') element.style.cssText = value;
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/** An element of HTML with attributes (`onclick` and the like are listeners) and children. */
export const h = (tag, attributes, ...children) => fill(document.createElement(tag), attributes, children);

/** The same of SVG. */
export const svg = (tag, attributes, ...children) => fill(document.createElementNS(SVG, tag), attributes, children);

/** A row of buttons of which one is pressed; arrow keys move between them. `choose` is called with its value. */
export function choice(label, options, chosen, choose) {
  const buttons = options.map(({ value, text, title }) =>
    h('button', { type: 'button', role: 'radio', 'data-value': value, title, onclick: () => select(value) }, text));
  const select = (value) => {
    for (const button of buttons) {
      const on = button.dataset.value === String(value);
      button.setAttribute('aria-checked', on);
      button.tabIndex = on ? 0 : -1;
    }
    choose(value);
  };
  const group = h('div', { class: 'choice', role: 'radiogroup', 'aria-label': label }, buttons);
  group.addEventListener('keydown', (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    const at = buttons.indexOf(document.activeElement);
    if (!step || at < 0) return;
    event.preventDefault();
    const next = buttons[(at + step + buttons.length) % buttons.length];
    next.focus();
    next.click();
  });
  for (const button of buttons) {
    const on = button.dataset.value === String(chosen);
    button.setAttribute('aria-checked', on);
    button.tabIndex = on ? 0 : -1;
  }
  return { element: group, select };
}
