'use strict';
// What a report says, as sections. `page` is what output/html/html_page.hpp describes.

const MOST_ROWS = 60;

function cut(rows, what) {
  return rows.length > MOST_ROWS ? [rows.slice(0, MOST_ROWS), make('p', {class: 'faint'}, `and ${rows.length - MOST_ROWS} more ${what}, in the files beside this one`)] : [rows, null];
}

function warnings(page) {
  const found = page.report.warnings || [];
  if (!found.length) return null;
  const [shown, more] = cut(found, 'warnings');
  return make('section', {class: 'warnings'}, make('h2', {}, found.length === 1 ? 'A warning' : `${found.length} warnings`),
    make('ul', {}, shown.map(text => make('li', {}, make('bdi', {}, text)))), more);
}

/** The largest of the errors of a kind of sensor that has been measured. */
const measuredError = of => of.relative_error_rgb ? Math.max(...of.relative_error_rgb.filter(Number.isFinite)) : NaN;

/** One sentence or two, and whether all is well. */
function quality(page) {
  const {report} = page, said = [], of = page.of || 'picture';
  if (page.kind === 'compare') {
    const free = report.figure_is !== 'sigma_relative';
    said.push(`The root mean square difference is ${percent(report.figure)} of the reference's mean, in the colour where that is most${free ? ', without the noise of what is compared' : ''}.`);
    return [said, report.fail_above === undefined || report.figure <= report.fail_above];
  }
  if (page.kind === 'viewfactors') {
    said.push(`Where a side sees a closed enclosure its factors add up to 1: the sums here are ${number(report.row_sums.least, 6)} to ${number(report.row_sums.largest, 6)}, ${number(report.row_sums.mean, 6)} in the mean. The largest estimate of an error is ${number(report.largest_error)}; both directions of a pair differ by ${number(report.reciprocity)} at most.`);
    return [said, true];
  }
  if (report.measured) {
    const kinds = Object.entries(report.measured);
    for (const [what, found] of kinds.slice(0, 6))
      said.push([name(what), `: one standard error is ${percent(measuredError(found))} of the mean. `]);
    return [said, !page.unreached];
  }
  if (page.live) {
    said.push('The run has not ended yet; what is said here is what it has come to until now.');
    const silent = Date.now() / 1000 - page.written;
    if (silent > 60) said.push(` Nothing has been heard of it for ${seconds(silent)}: it may have been ended.`);
  }
  if (page.dry) said.push('A dry run: nothing has been solved; its forecast is in report.json.');
  if (report.stated_error !== undefined)
    said.push(`The error of the ${of} is stated as ${percent(report.stated_error)} of the mean, root mean square: nine of ten runs are below what they state.`);
  else if (report.error_estimate && report.error_estimate.discretisation_rgb)
    said.push(`By solutions on two coarser meshes the error is estimated as ${percent(Math.max(...report.error_estimate.discretisation_rgb))} of the mean.`);
  else if (!page.live && !page.dry) said.push('How far this solution is off is not known: the run has made no estimate of its error.');
  if (report.audit) {
    const {error, worst} = report.audit;
    said.push(` Paths of light, which share nothing with the method, have measured ${percent(error.value)} (${percent(error.low)} to ${percent(error.high)} with a chance of 95 %). `);
    const isCertain = Math.abs(worst.bias) > worst.half_interval;
    said.push(isCertain ? 'The part that is certainly most off is ' : 'No part is certainly off; what most may be is ', name(worst.name), `: by ${percent(worst.bias)} ± ${percent(worst.half_interval)}.`);
  }
  const isKnown = report.stated_error !== undefined || Boolean(report.error_estimate && report.error_estimate.discretisation_rgb);
  return [said, page.unreached ? false : isKnown ? true : null];
}

function howGood(page) {
  const [said, good] = quality(page);
  const missed = page.unreached ? make('p', {class: 'verdict bad'}, name(page.unreached[0].toUpperCase() + page.unreached.slice(1)), '.') : null;
  return section('How good it is', missed, said.length ? make('p', {class: `verdict ${good === null ? '' : good ? 'good' : 'bad'}`}, said) : null);
}

/** Where an audit says that a region of the picture is most off: shares of width and height. */
function worstRegion(report) {
  const found = report.audit && /^row (\d+), column (\d+) of (\d+) x (\d+)$/.exec(report.audit.worst.name);
  if (!found) return null;
  const [row, column, rows, columns] = found.slice(1).map(Number);
  return {top: (row - 1) / rows, left: (column - 1) / columns, height: 1 / rows, width: 1 / columns};
}

function figure(page, picture) {
  const image = make('img', {src: `data:image/png;base64,${picture.png}`, alt: shortened(picture.caption)});
  const region = picture.seen ? worstRegion(page.report) : null;
  const mark = region && make('i', {title: 'most off', style: Object.entries(region).map(([side, share]) => `${side}:${100 * share}%`).join(';')});
  return make('figure', {}, make('div', {class: region ? 'marked' : ''}, image, mark),
    make('figcaption', {}, name(picture.caption), region ? '; the frame marks the region that is most off' : ''));
}

function pictures(page) {
  const seen = page.pictures.filter(picture => !picture.receiver);
  return section(seen.length > 1 ? 'Pictures' : 'Picture', seen.length ? make('div', {class: 'figures'}, seen.map(picture => figure(page, picture))) : null);
}

const stated = (of, digits) => of ? `${number(of.value, digits)} ± ${of.error === undefined ? 'not known' : number(of.error, 2)}` : '–';

function receivers(page) {
  const {report} = page, all = Object.entries(report.receivers || report.measured || {}).filter(([, of]) => of.mean && of.mean.value !== undefined);
  const [rows, more] = cut(all.map(([title, of]) => [name(title), of.unit || page.units.irradiance, String(of.cells || of.sensors), stated(of.mean), stated(of.min), stated(of.max), stated(of.u0), stated(of.ud)]), 'receivers');
  const plans = page.pictures.filter(picture => picture.receiver);
  return section('Receivers', rows.length ? table(['receiver', 'unit', '>cells', '>mean', '>least', '>largest', '>U0', '>Ud'], rows) : null, more,
    rows.length ? make('p', {class: 'faint'}, 'U0 is least over mean, Ud least over largest; after ± one standard error.') : null,
    plans.length ? make('div', {class: 'figures'}, plans.map(picture => figure(page, picture))) : null,
    page.plans_left_out ? make('p', {class: 'faint'}, `${page.plans_left_out} more plans are in the files beside this one`) : null);
}

const VERDICTS = {pass: 'good', fail: 'bad'};

function tasks(page) {
  const rows = (page.report.tasks || []).flatMap(task => task.criteria.map(of => [name(task.name), name(of.zone), of.quantity, number(of.required), stated(of.found),
    {text: of.verdict, kind: VERDICTS[of.verdict] || ''}]));
  const observers = Object.entries(page.report.observers || {}).map(([title, of]) => [name(title), stated(of.ugr), stated(of.background_luminance), stated(of.indirect_illuminance)]);
  return section('Lighting tasks (EN 12464-1)', rows.length ? table(['task', 'zone', 'quantity', '>required', '>found', 'verdict'], rows) : null,
    observers.length ? table(['observer', '>UGR', '>background luminance [cd/m2]', '>indirect illuminance of the eye [lx]'], observers) : null);
}

function heat(page) {
  const all = page.report.thermal || [];
  const key = `temperature_${page.units.temperature.toLowerCase()}`;
  const [rows, more] = cut(all.map(row => [name(row.group), row.side, number(row.area_m2), number(row[key], 5), number(row.emissivity), number(row.net_w, 4), number(row.error_w, 2), number(row.convected_w)]), 'rows');
  return section('Heat', rows.length ? table(['group', 'side', '>area [m2]', `>mean temperature [${page.units.temperature}]`, '>emissivity', '>net [W]', '>error [W]', '>into air [W]'], rows) : null, more);
}

function energy(page) {
  const of = page.report.energy;
  if (!of) return null;
  const parts = ['absorbed', 'escaped', 'lost', 'dark', 'convected'].map(key => [key, of[key] || of[key + '_rgb']]).filter(([, found]) => found)
    .map(([key, found]) => ({label: {dark: 'on sides that are left out', convected: 'into air'}[key] || key, value: luminance(found)}));
  const defect = of.defect_relative;
  return section('Where the power goes', stackedBar(parts, page.units.flux),
    defect !== undefined ? make('p', {class: 'faint'}, `What is not accounted for is ${percent(defect)} of what is emitted, in the colour where that is most.`) : null);
}

/** Errors over time of the phases that have any: samples are [seconds, done, forecast, error, target]. */
function convergence(page) {
  const series = [], found = Object.entries(page.report.progress || {}).filter(([, record]) => record.target !== undefined);
  for (const [phase, record] of found.slice(0, COLOURS.length)) {
    const points = record.samples.map(sample => [sample.time_s, sample.error]);
    series.push({label: phase === 'solve' ? 'solve: residual' : phase.replace(/_/g, ' '), points});
    const times = points.map(([x]) => x).filter(x => x > 0);
    if (times.length > 1 && found.length < 4) series.push({label: `${phase.replace(/_/g, ' ')}: target`, points: [[times[0], record.target], [times[times.length - 1], record.target]], dashed: true});
  }
  return lines(series, 'seconds since the start of the phase', 'error');
}

function rounds(page) {
  const all = (page.report.hierarchy || {}).rounds || [];
  const rows = all.map((round, k) => [String(k + 1), number(round.links), number(round.leaves), percent(round.discretisation), seconds(round.refine_s), seconds(round.solve_s)]);
  return rows.length ? [make('h3', {}, 'Rounds'), table(['>round', '>links', '>leaves', '>error of the mesh', '>refinement', '>solve'], rows)] : [];
}

function ranksBars(report) {
  return ['visibility', 'corrections'].map(phase => {
    const rows = (report.ranks_detail || []).map((rank, k) => ({label: `rank ${k}, ${rank.host}`, of: rank[phase]})).filter(row => row.of);
    if (rows.length < 2) return null;
    const bars = barRows(rows.slice(0, MOST_ROWS).map(row => ({label: row.label, parts: [{name: 'busy', value: row.of.busy_s}, {name: 'messages', value: row.of.message_s}, {name: 'waiting', value: row.of.waiting_s}]})), 's');
    return bars ? [make('h3', {}, `Ranks, ${phase}`), bars] : null;
  }).flat().filter(part => part);
}

function time(page) {
  const {report} = page;
  const phases = Object.entries(report.time_s || {}).filter(([phase]) => phase !== 'total');
  const under = Object.entries(report.progress || {});
  const rows = phases.length ? phases.map(([phase, wall]) => ({label: phase.replace(/_/g, ' '), parts: [{name: 'time', value: wall}]}))
    : under.map(([phase, record]) => ({label: phase.replace(/_/g, ' '), parts: [{name: 'time', value: record.final_s}]}));
  const chart = convergence(page);
  return section('Time', barRows(rows, 's'), ranksBars(report), chart ? [make('h3', {}, 'Errors on the way'), chart] : null, rounds(page));
}

/** Of a run that lasts. */
function progress(page) {
  if (!page.live) return null;
  const rows = Object.entries(page.report.progress || {}).map(([phase, record]) => {
    const last = record.samples[record.samples.length - 1], runs = record.under_way;
    return [phase.replace(/_/g, ' '), runs ? 'under way' : 'done', seconds(record.final_s),
      record.forecast_s !== undefined ? seconds(Math.max(0, record.forecast_s - record.final_s)) : '–',
      percent(last.error), percent(record.target)];
  });
  return section('Progress', rows.length ? table(['phase', '', '>time', '>left', '>error', '>target'], rows) : make('p', {}, 'No long phase has begun yet.'));
}

function sizes(page) {
  const {report} = page, rows = [], add = (label, value) => { if (value !== undefined && value !== null) rows.push([label, value]); };
  const whole = value => value === undefined ? undefined : value.toLocaleString('en').replace(/,/g, ' ');
  add('patches', whole(report.patches));
  add('elements', whole(report.elements));
  add('links', report.hierarchy ? whole(report.hierarchy.rounds[report.hierarchy.rounds.length - 1].links) : undefined);
  add('pairs', report.visibility ? number(report.visibility.pairs) : undefined);
  add('photons', report.photons ? whole(report.photons.sent) : undefined);
  add('ranks and threads of each', report.ranks ? `${report.ranks} x ${report.threads}` : undefined);
  if (report.memory) {
    add('largest memory of a rank', bytes(report.memory.peak_rss_bytes_max));
    add('forecast of it', report.memory.predicted_bytes_max ? bytes(report.memory.predicted_bytes_max) : undefined);
  }
  return section('Size and memory', rows.length ? table(['', '>'], rows) : null);
}

function comparison(page) {
  if (page.kind !== 'compare') return null;
  const rows = Object.entries(page.report.colours).filter(([, of]) => of).map(([colour, of]) => [colour, number(of.mean), percent(of.bias_relative), percent(of.sigma_relative),
    of.noise_free ? percent(of.noise_free.sigma_relative) : '–', percent(of.percentile_99_relative), percent(of.largest_relative)]);
  return section('By colour', table(['colour', '>mean of the reference', '>bias', '>rms difference', '>without noise', '>99 of 100 below', '>largest'], rows),
    (page.report.notes || []).map(note => make('p', {class: 'faint'}, name(note))));
}

/** View factors of the largest surfaces as a map of colours. */
function factorMatrix(page) {
  const {matrix} = page;
  if (!matrix) return null;
  const count = matrix.surfaces.length, size = Math.max(4, Math.min(40, Math.floor(640 / count)));
  const canvas = make('canvas', {width: size * count, height: size * count, id: 'matrix', style: 'max-width:100%'}), context = canvas.getContext('2d');
  const values = new Map(matrix.factors.map(([from, to, factor]) => [from * count + to, factor]));
  for (let from = 0; from < count; ++from)
    for (let to = 0; to < count; ++to) {
      const factor = values.get(from * count + to) || 0;
      context.fillStyle = factor > 0 ? `rgb(${paletteColour(page.palette, Math.sqrt(factor)).map(Math.round)})` : '#e8ebee';
      context.fillRect(to * size, from * size, size, size);
    }
  const text = make('p', {class: 'faint'}, 'Rows are the surfaces that light leaves, columns those that it comes to. Click a square for its factor.');
  const title = k => matrix.surfaces[k].name + (matrix.surfaces[k].back ? ', back' : ', front');
  canvas.addEventListener('click', event => {
    const frame = canvas.getBoundingClientRect(), at = (from, span) => Math.min(count - 1, Math.max(0, Math.floor((from / span) * count)));
    const from = at(event.clientY - frame.top, frame.height), to = at(event.clientX - frame.left, frame.width);
    text.replaceChildren('from ', name(title(from)), ' to ', name(title(to)), `: F = ${number(values.get(from * count + to) || 0, 6)}`);
  });
  const sums = matrix.surfaces.map((surface, k) => [name(title(k)), number(surface.area_m2), number(surface.row_sum, 6)]);
  const [rows, more] = cut(sums, 'surfaces');
  return section('View factors', matrix.left_out ? make('p', {class: 'faint'}, `The ${count} largest surfaces; ${matrix.left_out} smaller ones are in the table beside this file.`) : null,
    canvas, text, scaleBar(page.palette, 0, 1, '(square root of F)'), table(['surface', '>area [m2]', '>sum of its factors'], rows), more);
}

function repeat(page) {
  const options = Object.entries(page.report.options || {}).map(([key, value]) => [key, name(typeof value === 'string' ? value : JSON.stringify(value))]);
  return section('To repeat it', page.command ? make('pre', {}, make('bdi', {}, page.command)) : null, page.version ? make('p', {class: 'faint'}, `Fluxel ${page.version}`) : null,
    options.length ? make('details', {}, make('summary', {}, 'all options in force'), table(['option', 'value'], options)) : null,
    (page.report.notes || []).length && page.kind !== 'compare' ? make('details', {}, make('summary', {}, 'notes on the scene'), make('ul', {}, page.report.notes.map(note => make('li', {}, make('bdi', {}, note))))) : null);
}
