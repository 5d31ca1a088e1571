'use strict';
// Charts as SVG. Colours are Okabe & Ito's, told apart with any colour vision.

const COLOURS = ['#0072B2', '#E69F00', '#009E73', '#D55E00', '#56B4E9', '#CC79A7', '#7F7F7F', '#F0E442'];

/** One bar of parts [{label, value}], with a legend; negative parts are left out. */
function stackedBar(parts, unit) {
  const shown = parts.filter(part => part.value > 0);
  const total = shown.reduce((sum, part) => sum + part.value, 0);
  if (!(total > 0)) return null;
  const width = 800, legend = 22, svg = make('svg', {viewBox: `0 0 ${width} ${44 + legend * Math.ceil(shown.length / 2)}`, role: 'img'});
  let x = 0;
  shown.forEach((part, k) => {
    const wide = part.value / total * width, colour = COLOURS[k % COLOURS.length];
    const label = `${part.label}: ${number(part.value)} ${unit} (${percent(part.value / total, 3)})`;
    svg.append(make('rect', {x, y: 4, width: wide, height: 28, fill: colour}, make('title', {}, label)));
    const at = {x: (k % 2) * width / 2, y: 40 + legend * Math.floor(k / 2)};
    svg.append(make('rect', {x: at.x, y: at.y, width: 12, height: 12, fill: colour}),
      make('text', {x: at.x + 18, y: at.y + 11}, label));
    x += wide;
  });
  return svg;
}

/** A row for each [{label, parts: [{name, value}]}], all to the same scale; names have the same colours. */
function barRows(rows, unit) {
  const names = [...new Set(rows.flatMap(row => row.parts.map(part => part.name)))];
  const largest = Math.max(...rows.map(row => row.parts.reduce((sum, part) => sum + part.value, 0)));
  if (!(largest > 0)) return null;
  const width = 800, left = 150, right = 90, high = 20, top = names.length > 1 ? 22 : 2;
  const svg = make('svg', {viewBox: `0 0 ${width} ${top + high * rows.length + 4}`, role: 'img'});
  if (names.length > 1)
    names.forEach((text, k) => svg.append(make('rect', {x: left + 130 * k, y: 4, width: 12, height: 12, fill: COLOURS[k % COLOURS.length]}),
      make('text', {x: left + 130 * k + 17, y: 15}, text)));
  rows.forEach((row, r) => {
    const y = top + high * r;
    svg.append(make('text', {x: left - 8, y: y + 14, 'text-anchor': 'end'}, shortened(row.label).slice(0, 24)));
    let x = left;
    for (const part of row.parts) {
      const wide = part.value / largest * (width - left - right);
      svg.append(make('rect', {x, y: y + 3, width: Math.max(wide, 0.5), height: high - 6, fill: COLOURS[names.indexOf(part.name) % COLOURS.length]},
        make('title', {}, `${row.label}, ${part.name}: ${number(part.value)} ${unit}`)));
      x += wide;
    }
    const sum = row.parts.reduce((total, part) => total + part.value, 0);
    svg.append(make('text', {x: x + 6, y: y + 14}, `${number(sum)} ${unit}`));
  });
  return svg;
}

function decades(least, most) {
  const found = [];
  for (let k = Math.ceil(Math.log10(least) - 1e-9); k <= Math.log10(most) + 1e-9; ++k) found.push(10 ** k);
  return found.length >= 2 ? found : [least, most];
}

/** Lines [{label, points: [[x, y]], dashed}] over logarithmic axes. */
function lines(series, xName, yName) {
  const known = series.map(line => ({...line, points: line.points.filter(([x, y]) => x > 0 && y > 0)})).filter(line => line.points.length > 1);
  if (!known.length) return null;
  const all = known.flatMap(line => line.points);
  const range = k => [Math.min(...all.map(p => p[k])), Math.max(...all.map(p => p[k]))];
  const [xs, ys] = [range(0), range(1)];
  if (ys[0] === ys[1]) ys[0] /= 2, ys[1] *= 2;
  if (xs[0] === xs[1]) return null;
  const width = 800, height = 320, left = 70, bottom = 44, top = 10, right = 170;
  const at = (value, [least, most], from, to) => from + Math.log(value / least) / Math.log(most / least) * (to - from);
  const X = x => at(x, xs, left, width - right), Y = y => at(y, ys, height - bottom, top);
  const svg = make('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img'});
  for (const x of decades(...xs))
    svg.append(make('line', {x1: X(x), x2: X(x), y1: top, y2: height - bottom, stroke: '#d5dae0'}),
      make('text', {x: X(x), y: height - bottom + 16, 'text-anchor': 'middle'}, number(x)));
  for (const y of decades(...ys))
    svg.append(make('line', {x1: left, x2: width - right, y1: Y(y), y2: Y(y), stroke: '#d5dae0'}),
      make('text', {x: left - 6, y: Y(y) + 4, 'text-anchor': 'end'}, number(y)));
  known.forEach((line, k) => {
    const colour = COLOURS[k % COLOURS.length];
    svg.append(make('path', {d: line.points.map(([x, y], i) => `${i ? 'L' : 'M'}${X(x).toFixed(1)} ${Y(y).toFixed(1)}`).join(''),
      fill: 'none', stroke: colour, 'stroke-width': 2, ...(line.dashed ? {'stroke-dasharray': '6 4'} : {})}));
    svg.append(make('line', {x1: width - right + 12, x2: width - right + 34, y1: 20 + 18 * k, y2: 20 + 18 * k, stroke: colour, 'stroke-width': 2,
      ...(line.dashed ? {'stroke-dasharray': '6 4'} : {})}), make('text', {x: width - right + 40, y: 24 + 18 * k}, shortened(line.label).slice(0, 20)));
  });
  svg.append(make('text', {x: (left + width - right) / 2, y: height - 8, 'text-anchor': 'middle'}, xName),
    make('text', {x: 16, y: (height - bottom) / 2, 'text-anchor': 'middle', transform: `rotate(-90 16 ${(height - bottom) / 2})`}, yName));
  return svg;
}

/** The colour of a place from 0 to 1, as [r, g, b] of 0 to 255. */
function paletteColour(palette, place) {
  const at = Math.min(Math.max(place, 0), 1) * (palette.length - 1), k = Math.min(Math.floor(at), palette.length - 2), t = at - k;
  return [0, 1, 2].map(c => palette[k][c] * (1 - t) + palette[k + 1][c] * t);
}

/** A strip of the palette between two values. */
function scaleBar(palette, from, to, unit) {
  const canvas = make('canvas', {width: 256, height: 1}), context = canvas.getContext('2d'), image = context.createImageData(256, 1);
  for (let x = 0; x < 256; ++x) image.data.set([...paletteColour(palette, x / 255), 255], 4 * x);
  context.putImageData(image, 0, 0);
  return make('span', {class: 'scale'}, number(from), canvas, `${number(to)} ${unit}`);
}
