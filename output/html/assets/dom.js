'use strict';
// Everything that a file or a user has named becomes text of the page here, never markup.

const LONGEST_TEXT = 300;

function shortened(text) {
  return text.length > LONGEST_TEXT ? text.slice(0, LONGEST_TEXT) + '…' : text;
}

/** An element: its attributes, then children, of which strings are text. */
function make(tag, attributes, ...children) {
  const svg = ['svg', 'g', 'rect', 'line', 'text', 'path', 'circle', 'title'].includes(tag);
  const element = svg ? document.createElementNS('http://www.w3.org/2000/svg', tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) element.setAttribute(name, value);
  for (const child of children.flat(Infinity))
    if (child !== null && child !== undefined) element.append(child);
  return element;
}

/** A name out of a file, whose direction of writing must not turn what stands beside it. */
function name(text) {
  return make('bdi', {}, shortened(String(text)));
}

/** With three digits, or more before the point; null where there is no number. */
function number(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) return value.toExponential(digits - 1).replace('e+', 'e');
  return size >= 10 ** (digits - 1) ? Math.round(value).toLocaleString('en').replace(/,/g, ' ') : String(Number(value.toPrecision(digits)));
}

function percent(value, digits = 2) {
  return value === null || value === undefined ? '–' : `${Number((100 * value).toPrecision(digits))} %`;
}

function seconds(value) {
  if (value >= 7200) return `${number(value / 3600)} h`;
  return value >= 120 ? `${number(value / 60)} min` : `${number(value)} s`;
}

function bytes(value) {
  const units = ['B', 'KiB', 'MiB', 'GiB', 'TiB'];
  let k = 0;
  for (; value >= 1024 && k < units.length - 1; ++k) value /= 1024;
  return `${number(value)} ${units[k]}`;
}

/** Rec. 709, as EN 12464 quantities are weighed. */
function luminance(rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/** Columns are names, with a leading > for numbers; a cell may be an element, or {text, kind}. */
function table(columns, rows) {
  const isNumber = columns.map(column => column.startsWith('>'));
  const cell = (value, k) => {
    const kinds = [isNumber[k] ? 'number' : '', value && value.kind ? value.kind : ''].join(' ').trim();
    const shown = value && value.text !== undefined && !(value instanceof Node) ? value.text : value;
    return make('td', kinds ? {class: kinds} : {}, shown instanceof Node || shown === null || shown === undefined ? shown : String(shown));
  };
  const head = columns.map((column, k) => make('th', isNumber[k] ? {class: 'number'} : {}, column.replace(/^>/, '')));
  const hasHead = columns.some(column => column.replace(/^>/, ''));
  return make('div', {class: 'scroll'}, make('table', {}, !hasHead ? null : make('thead', {}, make('tr', {}, head)),
    make('tbody', {}, rows.map(row => make('tr', {}, row.map(cell))))));
}

function section(title, ...children) {
  const found = children.flat(Infinity).filter(child => child);
  return found.length ? make('section', {}, make('h2', {}, title), found) : null;
}
