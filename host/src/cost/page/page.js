// Fills the page from the JSON and the pictures that stand in it. Any part of the report may be missing.
(() => {
'use strict';

// ---- Elements ----
const SVG = 'http://www.w3.org/2000/svg';

const filled = (node, attributes, children) => {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === true) node.setAttribute(name, '');
    else if (value !== false && value != null) node.setAttribute(name, value);
  }
  node.append(...children.flat().filter(child => child != null));
  return node;
};
const el = (tag, attributes = {}, ...children) => filled(document.createElement(tag), attributes, children);
const svg = (tag, attributes = {}, ...children) => filled(document.createElementNS(SVG, tag), attributes, children);
const part = name => document.querySelector(`[data-part="${name}"]`);
const aside = text => el('p', { class: 'aside' }, ...prose(text));

/** Text with `code` in backticks. */
const prose = text => String(text ?? '').split('`').map((piece, i) => i % 2 ? el('code', {}, piece) : piece);

/** A cell is text, a node, or { content, class }. Heads are [name, class]; narrow screens show the name beside each cell. */
const table = (heads, rows, { caption, style = '' } = {}) => {
  const cell = (it, k) => {
    const { content, class: own = '' } = it !== null && typeof it === 'object' && 'content' in it ? it : { content: it };
    const classes = `${heads[k][1] ?? ''} ${own}`.trim() || null;
    return k === 0 ? el('th', { scope: 'row', class: classes }, content) : el('td', { class: classes, 'data-name': heads[k][0] }, content);
  };
  return el('table', { class: style },
    caption ? el('caption', {}, caption) : null,
    el('thead', {}, el('tr', {}, heads.map(([name, style]) => el('th', { scope: 'col', class: style }, name)))),
    el('tbody', {}, rows.map(row => el('tr', {}, row.map(cell)))));
};

let groups = 0;
/** Radio buttons in a row: options are [value, words], the first is chosen. */
const choice = (words, options, changed) => {
  const name = `choice${groups++}`;
  return el('fieldset', {}, el('legend', { class: 'hidden' }, words), options.map(([value, text], i) => {
    const input = el('input', { type: 'radio', name, value, checked: i === 0 });
    input.addEventListener('change', () => changed(value));
    return el('label', {}, input, el('span', {}, text));
  }));
};

const slider = (words, low, high, step, start, said, changed) => {
  const input = el('input', { type: 'range', min: low, max: high, step, value: start, 'aria-label': words });
  const output = el('output', {}, said(start));
  input.addEventListener('input', () => { output.textContent = said(Number(input.value)); changed(Number(input.value)); });
  return el('label', { class: 'slider' }, words, input, output);
};

const button = (words, pressed, label) => {
  const it = el('button', { type: 'button', 'aria-label': label }, words);
  it.addEventListener('click', pressed);
  return it;
};

// ---- Numbers ----
const list = x => (Array.isArray(x) ? x : []).filter(item => item != null);
const known = x => typeof x === 'number' && Number.isFinite(x);
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const raised = n => String(n).replace('+', '').replace(/./g, c => c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]);

/** Three digits. */
const short = x => {
  if (!known(x)) return 'not known';
  const size = Math.abs(x), sign = x < 0 ? '−' : '';
  if (size === 0) return '0';
  if (size >= 1e-3 && size < 1e4) return sign + Number(size.toFixed(clamp(2 - Math.floor(Math.log10(size)), 0, 5)));
  const [digits, exponent] = size.toExponential(1).split('e');
  return sign + (digits === '1.0' ? '' : `${digits}·`) + '10' + raised(exponent);
};
const count = n => known(n) ? Math.round(n).toString().replace(/\B(?=(\d{3})+$)/g, '\u202f') : 'not known';
const percent = x => known(x) ? `${short(100 * x)}\u00a0%` : 'not known';
const times = x => known(x) ? `${short(x)}\u00a0×` : 'not known';
const stops = x => `${x > 0 ? '+' : ''}${short(x)} stops`;

const UNITS = [[365.25 * 86400, 'years'], [2 * 86400, 'days', 86400], [7200, 'h', 3600], [300, 'min', 60], [1, 's'], [1e-3, 'ms'], [0, 'µs', 1e-6]];
const seconds = x => {
  if (!known(x)) return 'not known';
  const [least, unit, size = least] = UNITS.find(([least]) => x >= least * 0.9995) ?? UNITS.at(-1);
  return `${short(x / size)}\u00a0${unit}`;
};
const tickSeconds = x => x < 100 ? seconds(x) : `${short(x)}\u00a0s`;
const tickPower = x => {
  const exponent = Math.floor(Math.log10(x) + 1e-9), digit = Math.round(x / 10 ** exponent);
  if (exponent >= -2 && exponent <= 1) return short(x);
  return (digit === 1 ? '' : `${digit}·`) + '10' + raised(exponent);
};

const mean = values => values.length ? values.reduce((sum, v) => sum + v, 0) / values.length : null;
/** Least, middle and largest over the seeds. The middle is the geometric mean where all are above 0. */
const spread = values => {
  const all = values.filter(known);
  if (!all.length) return null;
  return { low: Math.min(...all), mid: all.every(v => v > 0) ? Math.exp(mean(all.map(Math.log))) : mean(all), high: Math.max(...all) };
};

// ---- Methods ----
const METHODS = ['path', 'light', 'bdpt', 'auto'];
const methodStyle = name => METHODS.includes(name) ? name : 'other';

/** A circle, square, triangle, diamond or the triangle's reverse: colour is never the only sign. */
const mark = (shape, x, y, r) => [
  `M${x - r},${y}a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0z`,
  `M${x - r * 0.9},${y - r * 0.9}h${r * 1.8}v${r * 1.8}h${-r * 1.8}z`,
  `M${x},${y - r * 1.2}l${r * 1.15},${r * 2}h${-r * 2.3}z`,
  `M${x},${y - r * 1.3}l${r * 1.3},${r * 1.3}l${-r * 1.3},${r * 1.3}l${-r * 1.3},${-r * 1.3}z`,
  `M${x},${y + r * 1.2}l${r * 1.15},${-r * 2}h${-r * 2.3}z`,
][shape % 5];
const methodShape = name => METHODS.includes(name) ? METHODS.indexOf(name) : 4;

/** A bias with its interval; it stands out where the interval leaves 0 out, or where it is declared. */
const biasCell = bias => {
  const declared = bias?.declared ? el('small', {}, `declared: ${bias.declared}`) : null;
  if (!known(bias?.value)) return declared ? { content: [declared], class: 'declared' } : 'not known';
  const { value, low, high } = bias, interval = known(low) && known(high), off = interval && (low > 0 || high < 0);
  // No more digits than the interval bears out.
  const digits = high > low ? clamp(1 - Math.floor(Math.log10(100 * (high - low))), 0, 6) : 3;
  const said = x => (x > 0 ? '+' : '') + (100 * x).toFixed(digits).replace(/^-(?=[0.]*$)/, '').replace('-', '−');
  return {
    content: [`${said(value)}\u00a0%`, el('small', { class: 'nowrap' }, interval ? `${said(low)} … ${said(high)}\u00a0%` : 'interval not known'),
      declared ?? (off ? el('small', {}, 'the interval leaves 0 out') : null)],
    class: declared ? 'declared' : off ? 'off' : '',
  };
};

// ---- Charts ----
/** A logarithmic axis from pixel `near` to pixel `far`, with a little room at both ends. */
const axis = (values, near, far) => {
  const [least, most] = [Math.min(...values), Math.max(...values)].map(Math.log10), room = Math.max(0.05 * (most - least), (0.6 - (most - least)) / 2);
  const [low, high] = [least - room, most + room];
  return { low, high, near, far, at: v => near + (Math.log10(v) - low) / (high - low) * (far - near) };
};

const ticks = ({ low, high, near, far }, apart) => {
  const every = Math.ceil((high - low) * apart / Math.abs(far - near)), named = high - low > 1.5 ? [1] : [1, 2, 5], all = [];
  for (let exponent = Math.floor(low); exponent <= high; exponent++) {
    for (let digit = 1; digit < 10; digit++) {
      const place = exponent + Math.log10(digit);
      if (place >= low && place <= high) all.push({ value: digit * 10 ** exponent, whole: digit === 1, named: named.includes(digit) && exponent % every === 0 });
    }
  }
  return all;
};

let clips = 0;
/**
 * A log–log chart. Returns what draws it: { xName, yName, series, lines }. A series is { style, shape, joined, hollow, points } and a
 * point { x, y, low, high, said }; a line { style, through: [x, y], slope }. Pointing at a point or walking there with the arrow keys
 * says it in words.
 */
const chart = (host, label) => {
  const clip = `clip${clips++}`;
  const drawing = el('div');
  const readout = el('output', { class: 'readout' });
  host.append(drawing, readout);
  let what = null, width = 0;

  const rule = (whole, x1, y1, x2, y2) => svg('line', { class: whole ? 'grid' : 'fine', x1, y1, x2, y2 });
  const grid = (x, y) => [
    ...ticks(x, 52).flatMap(({ value, whole, named }) => [rule(whole, x.at(value), y.near, x.at(value), y.far),
      named ? svg('text', { x: x.at(value), y: y.near + 16, 'text-anchor': 'middle' }, tickSeconds(value)) : null]),
    ...ticks(y, 22).flatMap(({ value, whole, named }) => [rule(whole, x.near, y.at(value), x.far, y.at(value)),
      named ? svg('text', { x: x.near - 6, y: y.at(value) + 4, 'text-anchor': 'end' }, tickPower(value)) : null]),
  ];

  const line = (x, y, { style, through, slope }) => {
    const end = power => y.at(10 ** (Math.log10(through[1]) + slope * (power - Math.log10(through[0]))));
    return svg('line', { class: style, x1: x.near, y1: end(x.low), x2: x.far, y2: end(x.high) });
  };

  const ribbon = (points, x, y) => {
    const bottom = v => v > 0 ? y.at(v) : y.near;
    if (points.length === 1) {
      const [p] = points;
      return svg('line', { class: 'whisker', x1: x.at(p.x), x2: x.at(p.x), y1: bottom(p.low), y2: bottom(p.high) });
    }
    const edge = [...points.map(p => [p.x, p.high]), ...points.map(p => [p.x, p.low]).reverse()];
    return svg('polygon', { class: 'ribbon', points: edge.map(([t, v]) => `${x.at(t)},${bottom(v)}`).join(' ') });
  };

  const curve = (series, x, y) => {
    const places = series.points.map(p => [x.at(p.x), y.at(p.y)]);
    const spreads = series.points.filter(p => known(p.low) && known(p.high));
    const group = svg('g', { class: `series ${series.style}` },
      spreads.length ? ribbon(spreads, x, y) : null,
      series.joined ? svg('polyline', { class: 'joined', points: places.map(p => p.join()).join(' ') }) : null);
    const nodes = places.map(([px, py], i) => svg('g', { class: 'point', tabindex: -1, role: 'img', 'aria-label': series.points[i].said },
      svg('path', { class: `mark ${series.hollow ? 'hollow' : ''}`, d: mark(series.shape, px, py, 4.5) })));
    group.append(...nodes);
    return { group, found: nodes.map((node, i) => ({ node, x: places[i][0], y: places[i][1], said: series.points[i].said })) };
  };

  const draw = () => {
    width = host.clientWidth;
    const series = what.series.filter(s => s.points.length);
    const points = series.flatMap(s => s.points);
    readout.textContent = points.length ? 'Point at a mark, or walk with the arrow keys, to read it.' : '';
    if (!points.length) return drawing.replaceChildren(aside('There is no value above 0 to draw.'));
    const height = clamp(Math.round(width * 0.55), 280, 460);
    const x = axis(points.map(p => p.x), 50, width - 14);
    const y = axis(points.flatMap(p => [p.y, p.low, p.high]).filter(v => known(v) && v > 0), height - 40, 26);
    const curves = series.map(s => curve(s, x, y));
    const picture = svg('svg', { viewBox: `0 0 ${width} ${height}`, role: 'group', 'aria-label': label },
      svg('clipPath', { id: clip }, svg('rect', { x: x.near, y: y.far, width: x.far - x.near, height: y.near - y.far })),
      grid(x, y),
      svg('text', { x: 4, y: 14 }, what.yName),
      svg('text', { x: x.far, y: height - 6, 'text-anchor': 'end' }, what.xName),
      svg('g', { 'clip-path': `url(#${clip})` }, what.lines.map(l => line(x, y, l))),
      curves.map(c => c.group));
    drawing.replaceChildren(picture);
    explore(picture, curves.map(c => c.found), readout);
  };

  new ResizeObserver(() => { if (what && host.clientWidth && host.clientWidth !== width) draw(); }).observe(host);
  return next => { what = next; draw(); };
};

/** One tab stop for the chart; the arrow keys walk along a series and between series. Points are { node, x, y, said, row }. */
const explore = (picture, rows, readout) => {
  const points = rows.flatMap((row, r) => row.map(p => ({ ...p, row: r })));
  let now = points[0];
  const show = p => {
    now.node.classList.remove('now');
    now.node.setAttribute('tabindex', -1);
    now = p;
    now.node.classList.add('now');
    now.node.setAttribute('tabindex', 0);
    readout.textContent = now.said;
  };
  const far = (p, x, y) => Math.hypot(p.x - x, p.y - y);
  const nearest = (some, x, y) => some.reduce((best, p) => far(p, x, y) < far(best, x, y) ? p : best);
  const walked = key => {
    const own = points.filter(p => p.row === now.row), place = own.indexOf(now), turn = { ArrowDown: 1, ArrowUp: rows.length - 1 }[key];
    if (turn) return nearest(points.filter(p => p.row === (now.row + turn) % rows.length), now.x, now.y);
    return { ArrowRight: own[place + 1] ?? now, ArrowLeft: own[place - 1] ?? now, Home: own[0], End: own.at(-1) }[key];
  };
  const point = event => {
    const box = picture.getBoundingClientRect(), scale = picture.viewBox.baseVal.width / box.width;
    const [x, y] = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale], p = nearest(points, x, y);
    if (far(p, x, y) < 40) show(p);
  };
  now.node.setAttribute('tabindex', 0);
  picture.addEventListener('focusin', event => show(points.find(p => p.node === event.target)));
  picture.addEventListener('pointermove', point);
  picture.addEventListener('pointerdown', point);
  picture.addEventListener('keydown', event => {
    const next = walked(event.key);
    if (!next) return;
    event.preventDefault();
    next.node.focus();
  });
};

const keyEntry = (words, style, shape, { line = '', hollow = false } = {}) => el('li', {}, svg('svg', { viewBox: '0 0 30 14', 'aria-hidden': 'true', class: `series ${style}` },
  line ? svg('line', { class: line, x1: 0, x2: 30, y1: 7, y2: 7 }) : null,
  shape === null ? null : svg('path', { class: `mark ${hollow ? 'hollow' : ''}`, d: mark(shape, 15, 7, 4.5) })), el('span', {}, ...words));

// ---- Facts and headline ----
const facts = report => {
  const said = [
    report.scene, known(report.width) && `${report.width} × ${report.height} pixels`, known(report.seeds) && `${report.seeds} ${report.seeds === 1 ? 'seed' : 'seeds'}`,
    known(report.threads) && `${report.threads} ${report.threads === 1 ? 'thread' : 'threads'}`,
    known(report.spent) && `${seconds(report.spent)} spent${known(report.budget) ? ` of ${seconds(report.budget)}` : ''}`, report.version && `bidir ${report.version}`,
  ].filter(Boolean);
  const node = document.getElementById('facts');
  node.textContent = said.length ? `${said.join(', ')}.` : 'The report is empty.';
  if (report.interrupted || report.out_of_time) node.after(el('p', { class: 'note' }, `Not all of it was measured. What is missing is left out; ${report.interrupted ? 'the same command again goes on' : 'there was no time for it: a larger --budget has more'}.`));
  const failed = list(report.left_out);
  if (failed.length) node.after(el('div', { class: 'note' }, 'Left out, because it failed:', el('ul', {}, failed.map(what => el('li', {}, what)))));
  const { words, given, relmse } = report.reference ?? {};
  document.getElementById('reference').textContent = (words ? `The reference: ${words}${given ? ', given, not rendered for this report' : ''}. ` : 'There is no word on the reference. ')
    + (known(relmse) ? `By half the difference of its halves, the relMSE of their mean is about ${short(relmse)}; errors near that are uncertain.` : 'How good it is, is not known.');
  if (known(report.confidence)) {
    document.getElementById('confidence').textContent = `Its interval holds the true value in ${percent(report.confidence)} of such reports.`;
  }
};

const GOAL = 0.01;
const priceAt = (price, goal) => list(price.targets).find(target => Math.abs(target.relmse / goal - 1) < 0.01);
const payable = target => known(target?.cpu) && target.how !== 'never';
const about = target => target.how === 'extrapolated' ? '~\u00a0' : '';

const headlineWords = prices => {
  const rows = prices.map(price => ({ method: price.method, target: priceAt(price, GOAL) })).filter(row => row.target);
  const [best, ...others] = rows.filter(row => payable(row.target)).sort((a, b) => a.target.cpu - b.target.cpu);
  if (!best) return [`No method’s time to a relMSE of ${short(GOAL)} is known.`];
  const clock = known(best.target.wall) ? `, ${about(best.target)}${seconds(best.target.wall)} of wall time` : '';
  const single = others.length ? 'is the fastest' : 'is the only method with a known time';
  const first = `To a relMSE of ${short(GOAL)}, ${best.method} ${single}: ${about(best.target)}${seconds(best.target.cpu)} of CPU time${clock}.`;
  const rest = others.map(({ method, target }) => `${method} takes ${short(target.cpu / best.target.cpu)} times as long (${about(target)}${seconds(target.cpu)})`);
  for (const { method } of rows.filter(row => row.target.how === 'never')) rest.push(`${method} never gets there`);
  const guessed = [best, ...others].some(row => row.target.how === 'extrapolated') ? ' (~ is extrapolated.)' : '';
  return [first, rest.length ? `${rest.join('; ')}.${guessed}` : guessed.trim()];
};

const headline = report => {
  const host = document.getElementById('headline');
  const [first, rest] = headlineWords(list(report.prices));
  host.append(el('p', { class: 'headline' }, first));
  if (rest) host.append(el('p', {}, rest));
  const crossings = list(report.crossings);
  if (crossings.length) host.append(el('ul', {}, crossings.map(text => el('li', {}, ...prose(text)))));
};

// ---- Error against time ----
const MEASURES = {
  relmse: { name: 'relMSE', of: run => run.relmse, slope: -1 },
  trimmed: { name: 'trimmed relMSE', of: run => run.trimmed, slope: -1 },
  root: { name: 'root of relMSE', of: run => run.relmse, slope: -0.5 },
  smape: { name: 'SMAPE', of: run => run.smape, slope: -0.5 },
};
const CLOCKS = { cpu: 'CPU time', wall: 'wall time' };

const curvePoints = (method, clock, measure) => {
  const root = v => measure === 'root' ? Math.sign(v) * Math.sqrt(Math.abs(v)) : v;
  const { name, of } = MEASURES[measure];
  return list(method.points).flatMap(point => {
    const runs = list(point.runs), time = spread(runs.map(run => run[clock])), found = spread(runs.map(of));
    if (!time || !found) return [];
    const [low, y, high] = [found.low, found.mid, found.high].map(root);
    const seeds = runs.length > 1 ? ` (${short(low)} … ${short(high)} over ${runs.length} seeds)` : '';
    return [{ x: time.mid, y, low, high, said: `${method.name}, ${count(point.spp)} samples per pixel: ${seconds(time.mid)} of ${CLOCKS[clock]}, ${name} ${short(y)}${seeds}` }];
  });
};

const pointTable = methods => {
  const rows = methods.flatMap(method => list(method.points).map(point => {
    const runs = list(point.runs), of = key => spread(runs.map(run => run[key]));
    const range = it => it ? [short(it.mid), it.high > it.low ? el('small', { class: 'nowrap' }, `${short(it.low)} … ${short(it.high)}`) : null] : 'not known';
    const average = key => percent(mean(runs.map(run => run[key]).filter(known)));
    return [`${method.name}, ${count(point.spp)}`, seconds(of('cpu')?.mid), seconds(of('wall')?.mid), { content: range(of('relmse')) }, { content: range(of('trimmed')) },
      { content: range(of('smape')) }, average('bias'), average('fireflies')];
  }));
  const heads = ['Method, samples per pixel', 'CPU time', 'Wall time', 'relMSE', 'Trimmed', 'SMAPE', 'Bias', 'Fireflies'];
  return el('details', {}, el('summary', {}, 'The same as a table'), el('div', { class: 'scroll', tabindex: 0, role: 'group', 'aria-label': 'Errors of all methods' },
    table(heads.map((name, i) => [name, i ? 'number nowrap' : 'nowrap']), rows, { caption: 'Means over the seeds, below them the least and the largest.' })));
};

const errorSection = report => {
  const host = part('error'), methods = list(report.methods).filter(method => list(method.points).length);
  if (!methods.length) return host.append(aside('No errors were measured.'));
  const card = el('div', { class: 'set' }), place = el('div'), left = aside('');
  let clock = 'cpu', measure = 'relmse';
  const drawn = chart(place, 'Error against time, one line per method');
  const update = () => {
    const { name, slope } = MEASURES[measure];
    const all = methods.map(method => ({ style: methodStyle(method.name), shape: methodShape(method.name), joined: true, points: curvePoints(method, clock, measure) }));
    const series = all.map(s => ({ ...s, points: s.points.filter(p => p.x > 0 && p.y > 0) }));
    const points = series.flatMap(s => s.points), lost = all.flatMap(s => s.points).length - points.length;
    const best = points.reduce((b, p) => !b || p.y * p.x ** -slope < b.y * b.x ** -slope ? p : b, null);
    const lines = best ? [{ style: 'guide', through: [best.x, best.y], slope }] : [];
    const own = report.reference?.relmse;
    if (known(own) && own > 0 && ['relmse', 'root'].includes(measure)) lines.push({ style: 'floor', through: [1, measure === 'root' ? Math.sqrt(own) : own], slope: 0 });
    left.textContent = lost ? `Not drawn: ${lost} ${lost === 1 ? 'point' : 'points'} whose mean is not above 0, within the noise of the reference.` : '';
    drawn({ xName: CLOCKS[clock], yName: name, series, lines });
  };
  const key = el('ul', { class: 'key' },
    methods.map(m => keyEntry([el('b', {}, m.name), m.words ? ` ${m.words}` : ''], methodStyle(m.name), methodShape(m.name), { line: 'joined' })),
    keyEntry(['error ∝ 1/time through the best point: slope −1 in relMSE, −½ in its root and in SMAPE'], '', null, { line: 'guide' }),
    known(report.reference?.relmse) ? keyEntry([`the reference’s own relMSE, about ${short(report.reference.relmse)}`], '', null, { line: 'floor' }) : null);
  card.append(el('div', { class: 'controls' },
    choice('Time', [['cpu', 'CPU time'], ['wall', 'wall time']], value => { clock = value; update(); }),
    choice('Error', [['relmse', 'relMSE'], ['trimmed', 'trimmed'], ['root', '√relMSE'], ['smape', 'SMAPE']], value => { measure = value; update(); })),
  place, key, left, pointTable(methods));
  host.append(card);
  update();
};

// ---- Prices ----
const priceCell = (target, best) => {
  if (!target) return 'not measured';
  if (target.how === 'never') return 'never';
  if (!known(target.cpu)) return 'not known';
  const wall = known(target.wall) ? el('small', { class: 'nowrap' }, `${about(target)}${seconds(target.wall)} wall`) : null;
  return { content: [el('span', { class: 'nowrap' }, `${about(target)}${seconds(target.cpu)}`), target === best ? ' (least)' : null, wall], class: target === best ? 'best' : '' };
};

const priceSection = report => {
  const host = part('prices'), prices = list(report.prices), methods = list(report.methods);
  if (!prices.length) return host.append(aside('No prices were worked out.'));
  const goals = [...new Set(prices.flatMap(price => list(price.targets).map(target => target.relmse)))].sort((a, b) => b - a);
  const best = goals.map(goal => prices.map(price => priceAt(price, goal)).filter(payable).sort((a, b) => a.cpu - b.cpu)[0]);
  const rows = prices.map(price => {
    const method = methods.find(m => m.name === price.method);
    return [price.method, ...goals.map((goal, k) => priceCell(priceAt(price, goal), best[k])), biasCell(method?.bias)];
  });
  host.append(el('div', { class: 'set' }, table([['Method'], ...goals.map(goal => [`relMSE ${short(goal)}`, 'number']), ['Bias', 'number wide']], rows,
    { style: 'stack', caption: 'CPU time, and below it wall time. ~ is extrapolated: as 1/t from the last three points. “Never”: the method misses light, so it settles on another picture.' })));
};

// ---- Knobs ----
const settingsOf = knobs => knobs.flatMap(knob => list(knob.settings).map(setting => ({ ...setting, knob: knob.knob })));
const settingName = s => `${s.knob} ${s.setting}`;

const efficiencyCell = (setting, base, largest) => {
  if (!known(setting.efficiency) || !known(base?.efficiency) || !(base.efficiency > 0)) return 'not known';
  const ratio = setting.efficiency / base.efficiency;
  const bar = el('span', { class: 'bar', 'aria-hidden': 'true' }, el('i'), el('b'));
  bar.firstChild.style.width = `${100 * clamp(ratio / largest, 0, 1)}%`;
  bar.lastChild.style.left = `calc(${100 / largest}% - 1px)`;
  return { content: [times(ratio), bar] };
};

const knobCard = knob => {
  const settings = list(knob.settings), base = settings.find(s => s.base) ?? settings[0];
  const largest = Math.max(1, ...settings.map(s => s.efficiency / base?.efficiency).filter(known));
  const rows = settings.map(s => [
    { content: [s.setting, s === base ? el('small', {}, s.base ? 'base' : 'first; no base was measured') : null, s.pareto ? el('small', { class: 'front' }, '◆ on the front') : null] },
    { content: [seconds(s.cpu), known(s.spp) ? el('small', { class: 'nowrap' }, `${count(s.spp)} spp`) : null] },
    { content: [short(s.relmse), known(s.trimmed) ? el('small', { class: 'nowrap' }, `trimmed ${short(s.trimmed)}`) : null] },
    biasCell(s.bias), efficiencyCell(s, base, largest)]);
  return el('div', { class: 'set' }, el('h3', {}, knob.knob), knob.words ? aside(knob.words) : null,
    rows.length ? table([['Setting'], ['CPU time', 'number'], ['relMSE', 'number'], ['Bias', 'number'], ['Efficiency', 'number']], rows, { style: 'stack' })
      : aside('No setting was measured.'));
};

const scatterCard = knobs => {
  const settings = settingsOf(knobs).filter(s => s.cpu > 0 && s.relmse > 0);
  if (!settings.length) return null;
  const card = el('div', { class: 'set' }, el('h3', {}, 'All settings')), place = el('div');
  const said = s => `${settingName(s)}: ${seconds(s.cpu)}, relMSE ${short(s.relmse)}${s.base ? ', base' : ''}${s.pareto ? ', on the front' : ''}`;
  const points = some => some.map(s => ({ x: s.cpu, y: s.relmse, said: said(s) })).sort((a, b) => a.x - b.x);
  const front = settings.filter(s => s.pareto).sort((a, b) => a.cpu - b.cpu);
  const drawn = chart(place, 'Error against time of all settings');
  const update = knob => drawn({ xName: CLOCKS.cpu, yName: 'relMSE', lines: [], series: [
    { style: 'plain', shape: 0, hollow: true, points: points(settings.filter(s => !s.pareto && s.knob !== knob)) },
    { style: 'onfront', shape: 3, joined: true, points: points(front) },
    { style: 'chosen', shape: 1, points: points(settings.filter(s => s.knob === knob)) }] });
  const select = el('select', {}, el('option', { value: '' }, 'none'), [...new Set(settings.map(s => s.knob))].map(name => el('option', {}, name)));
  select.addEventListener('change', () => update(select.value));
  card.append(el('div', { class: 'controls' }, el('label', { class: 'slider' }, 'Mark the settings of', select)), place,
    el('ul', { class: 'key' }, keyEntry(['on the front'], 'onfront', 3, { line: 'joined' }), keyEntry(['other settings'], 'plain', 0, { hollow: true }), keyEntry(['the marked knob’s'], 'chosen', 1)),
    aside(front.length ? `On the front, from fast to exact: ${front.map(s => `${settingName(s)} (${seconds(s.cpu)}, ${short(s.relmse)})`).join('; ')}.` : 'No setting is marked as on the front.'));
  part('scatter').append(card);
  update('');
};

const knobSection = report => {
  const knobs = list(report.knobs), guards = list(report.guards);
  scatterCard(knobs);
  part('knobs').append(knobs.length ? el('div', { class: 'cards' }, knobs.map(knobCard)) : aside('No knob was turned.'));
  if (!guards.length) return part('guards').append(aside('No guard’s price was measured.'));
  const rows = guards.map(guard => [guard.guard, times(guard.price), { content: prose(guard.words) }]);
  part('guards').append(el('div', { class: 'set' }, el('h3', {}, 'What the guards cost'), aside('Time with the guard over time without it.'),
    table([['Guard'], ['Price', 'number nowrap'], ['Measured as', 'wide']], rows, { style: 'stack' })));
};

// ---- Where the time went ----
const PARTS = ['#56b4e9', '#e69f00', '#2bb08a', '#f0e442', '#e8743b', '#d68fb8', '#a9adb3', '#9aa7f0'];

const raysTable = rays => {
  const { counted, predicted } = rays ?? {};
  if (!counted && !predicted) return aside('Rays were not counted.');
  let differ = false;
  const rows = ['closest', 'any'].map(kind => {
    const c = counted?.[kind], p = predicted?.[kind], off = known(c) && known(p) && c !== p;
    differ ||= off;
    const verdict = !known(c) || !known(p) ? 'nothing to compare' : off ? `✗ ${c > p ? '+' : '−'}${count(Math.abs(c - p))}` : '✓ equal';
    return [`${kind} hit`, count(c), count(p), { content: verdict, class: off ? 'off' : '' }];
  });
  return el('div', {}, table([['Rays'], ['Counted', 'number'], ['Predicted', 'number'], ['Counted − predicted', 'number']], rows, { style: 'stack' }),
    differ ? el('p', { class: 'note' }, 'Counted and predicted rays differ: the prediction misses something.') : null);
};

const timeSection = report => {
  const host = part('time'), time = report.time ?? {}, parts = list(time.parts);
  if (!parts.length) return host.append(aside('Where the time went was not measured.'), time.rays ? el('div', { class: 'set' }, raysTable(time.rays)) : '');
  const total = parts.reduce((sum, p) => sum + (known(p.seconds) ? p.seconds : 0), 0);
  const share = p => total > 0 && known(p.seconds) ? p.seconds / total : 0;
  const bar = el('div', { class: 'parts', role: 'img', 'aria-label': 'Shares of the time, as in the table below' });
  const rows = parts.map((p, i) => {
    const piece = el('span', { title: `${p.name}: ${percent(share(p))}` }, share(p) > 0.04 ? String(i + 1) : '');
    const swatch = el('span', { class: 'swatch', 'aria-hidden': 'true' }, String(i + 1));
    piece.style.flex = `${share(p)} 0 0`;
    piece.style.background = swatch.style.background = PARTS[i % PARTS.length];
    if (share(p) > 0) bar.append(piece);
    const traced = p.rays && known(p.tracing);
    return [{ content: [swatch, p.name] }, seconds(p.seconds), percent(share(p)), traced ? seconds(p.tracing) : '', traced ? seconds(p.seconds - p.tracing) : '',
      count(p.rays?.closest), count(p.rays?.any)];
  });
  const traced = parts.reduce((sum, p) => sum + (p.tracing ?? 0), 0), shaded = parts.reduce((sum, p) => sum + (p.rays && known(p.tracing) ? p.seconds - p.tracing : 0), 0);
  const split = traced > 0 ? ` Tracing rays takes ${seconds(traced)} of it, shading what they meet ${seconds(shaded)}.` : '';
  host.append(el('div', { class: 'set' }, aside(`${time.words ? `${time.words}. ` : ''}In sum ${seconds(total)}.${split}`), bar,
    table([['Part'], ['Time', 'number'], ['Share', 'number'], ['Tracing', 'number'], ['Shading', 'number'], ['Closest-hit rays', 'number'], ['Any-hit rays', 'number']], rows, { style: 'stack' })),
  el('div', { class: 'set' }, el('h3', {}, 'Rays counted and predicted'), raysTable(time.rays)));
};

// ---- Techniques and plan ----
const pyramidSection = report => {
  const host = part('pyramid'), techniques = list(report.pyramid?.techniques);
  if (!techniques.length) return host.append(aside('No picture of the techniques was made.'));
  const place = el('div', { class: 'scroll', tabindex: 0, role: 'group', 'aria-label': 'Pictures of the techniques' });
  const range = values => [...new Set(values)].sort((a, b) => a - b);
  const columns = range(techniques.map(t => t.s)), lengths = range(techniques.map(t => t.s + t.t - 1));
  const draw = kind => {
    const cell = t => t ? { content: [t[kind] ? el('img', { src: t[kind], alt: `Technique s = ${t.s}, t = ${t.t}, ${kind}` }) : aside('no picture'), `t = ${t.t}`,
      el('small', { class: 'nowrap' }, `mean ${short(t[`mean_${kind}`])}`)] } : '';
    const rows = lengths.map(k => [`length ${k}`, ...columns.map(s => cell(techniques.find(t => t.s === s && t.s + t.t - 1 === k)))]);
    place.replaceChildren(table([['s + t − 1', 'nowrap'], ...columns.map(s => [`s = ${s}`])], rows, { style: 'techniques' }));
  };
  host.append(el('div', { class: 'set' }, el('h3', {}, 'What each technique brings'),
    aside('Technique (s, t) joins s vertices from a light with t vertices from the camera. Weighted pictures add up to the whole picture; unweighted ones each show all light the technique can find.'),
    el('div', { class: 'controls' }, choice('Pictures', [['weighted', 'weighted'], ['unweighted', 'unweighted']], draw)), place));
  draw('weighted');
};

const planSection = report => {
  const lines = list(report.plan);
  part('plan').append(lines.length ? el('div', { class: 'set' }, el('h3', {}, 'Plan'), el('pre', { tabindex: 0 }, lines.join('\n'))) : aside('There is no plan.'));
};

// ---- Pictures ----
const half = bits => {
  const sign = bits & 0x8000 ? -1 : 1, exponent = bits >> 10 & 31, fraction = bits & 1023;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
};

const HALVES = Float32Array.from({ length: 65536 }, (_, bits) => half(bits));

/** Linear radiance, three values per pixel; null if the text holds no such picture. */
const decoded = (text, width, height) => {
  let bytes = '';
  try { bytes = atob(text.trim()); } catch { return null; }
  if (!(width > 0 && height > 0) || bytes.length !== width * height * 6) return null;
  const data = new Float32Array(width * height * 3);
  for (let i = 0; i < data.length; i++) data[i] = HALVES[bytes.charCodeAt(2 * i) | bytes.charCodeAt(2 * i + 1) << 8];
  return data;
};

/** The pictures that can be read and have the size of the first. */
const pictures = report => {
  const words = new Map(list(report.images).map(image => [image.name, image.words]));
  const all = [...document.querySelectorAll('script.image')].map(node => {
    const { name } = node.dataset, width = Number(node.dataset.width), height = Number(node.dataset.height);
    return { name, words: words.get(name) ?? '', width, height, data: decoded(node.textContent, width, height) };
  }).filter(image => image.data);
  return all.filter(image => image.width === all[0].width && image.height === all[0].height);
};

const BAD = [255, 0, 255];
const srgb = v => 255 * (v <= 0 ? 0 : v >= 1 ? 1 : v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
const difference = (x, r) => x - r;
const squaredError = (x, r) => (x - r) ** 2 / (r * r + 0.01);
/** The mean over the bands of the pixel that begins at `at`. */
const bands = (a, b, at, of) => (of(a[at], b[at]) + of(a[at + 1], b[at + 1]) + of(a[at + 2], b[at + 2])) / 3;

/** The colour at 0 … 1 between equally spaced ones. */
const between = (colours, x) => {
  const place = clamp(x, 0, 1) * (colours.length - 1), i = Math.min(Math.floor(place), colours.length - 2);
  return colours[i].map((c, k) => c + (place - i) * (colours[i + 1][k] - c));
};
const SIGNED = [[5, 48, 97], [67, 147, 195], [255, 255, 255], [214, 96, 77], [103, 0, 31]];
const VIRIDIS = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
const ERRORS = [-4, 1]; // powers of ten at the ends of the false colours

const SHADES = {
  picture: (x, _, { exposure }) => { const gain = 2 ** exposure; return at => [srgb(gain * x[at]), srgb(gain * x[at + 1]), srgb(gain * x[at + 2])]; },
  difference: (x, other, { scale }) => at => between(SIGNED, 0.5 + 0.5 * bands(x, other, at, difference) / 2 ** scale),
  error: (x, other) => at => between(VIRIDIS, (Math.log10(bands(x, other, at, squaredError)) - ERRORS[0]) / (ERRORS[1] - ERRORS[0])),
};

const painted = ({ image, other = image, shade }, state) => {
  const canvas = el('canvas', { width: image.width, height: image.height });
  const context = canvas.getContext('2d'), out = context.createImageData(image.width, image.height);
  const colour = SHADES[shade](image.data, other.data, state);
  for (let i = 0; i < image.width * image.height; i++) {
    const finite = Number.isFinite(bands(image.data, other.data, 3 * i, (a, b) => a + b));
    out.data.set(finite ? colour(3 * i) : BAD, 4 * i);
    out.data[4 * i + 3] = 255;
  }
  context.putImageData(out, 0, 0);
  return canvas;
};

/** What the two panes show: { image, shade, other, words }. An error map is against the reference, or against B if there is none. */
const contents = (state, images) => {
  const [a, b] = state.shown.map(i => images[i]), reference = images.find(image => image.name === 'reference') ?? b;
  const picture = image => ({ image, shade: 'picture', words: [image.name, image.words].filter(Boolean).join(', ') });
  const error = image => image === reference ? picture(image)
    : { image, other: reference, shade: 'error', words: `relative squared error of ${image.name} against ${reference.name}` };
  if (state.view === 'difference') return [picture(a), { image: a, other: b, shade: 'difference', words: `${a.name} − ${b.name}` }];
  return [a, b].map(state.view === 'error' ? error : picture);
};

const scaleLegend = state => {
  if (state.view === 'picture') return '';
  const [colours, marks] = state.view === 'difference' ? [SIGNED, [`≤ −${short(2 ** state.scale)}`, '0', `≥ ${short(2 ** state.scale)}`]]
    : [VIRIDIS, Array.from({ length: ERRORS[1] - ERRORS[0] + 1 }, (_, i) => tickPower(10 ** (ERRORS[0] + i)))];
  const ramp = el('div');
  ramp.style.background = `linear-gradient(to right, ${colours.map(c => `rgb(${c})`).join()})`;
  return el('div', { class: 'scale' }, ramp, el('p', {}, marks.map(text => el('span', {}, text))),
    state.view === 'difference' ? 'Mean of the bands of A − B: blue where A is darker, red where it is brighter.' : 'Mean over the bands of (x − r)² / (r² + 0.01).');
};

const pixelWords = (state, images) => {
  if (!state.cursor) return aside('Point at a pixel to read its values; with a pane in focus, Shift and the arrow keys go from pixel to pixel.');
  const { x, y } = state.cursor, [a, b] = state.shown.map(i => images[i]), at = 3 * (y * a.width + x);
  const value = v => Number.isFinite(v) ? short(v) : String(v).replace('-', '−').replace('Infinity', '∞');
  const row = (words, of) => [words, ...[0, 1, 2].map(i => value(of(a.data[at + i], b.data[at + i])))];
  return table([[`Pixel ${x}, ${y}`], ['R', 'number'], ['G', 'number'], ['B', 'number']],
    [row(`A ${a.name}`, p => p), row(`B ${b.name}`, (_, q) => q), row('A − B', difference), row('(A − B)² / (B² + 0.01)', squaredError)]);
};

const KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Where the picture lies in a pane: u and v are its point in the middle, as shares of its sides; both panes share them. */
const paneMap = (canvas, { width, height, zoom, u, v }) => {
  const scale = Math.min(canvas.clientWidth / width, canvas.clientHeight / height) * zoom;
  return { scale, left: canvas.clientWidth / 2 - u * width * scale, top: canvas.clientHeight / 2 - v * height * scale };
};

const look = (state, u, v) => {
  const edge = 0.5 / state.zoom;
  [state.u, state.v] = [u, v].map(x => clamp(x, edge, 1 - edge));
};

/** Zooms so that what is at (x, y) of the pane, or in its middle, stays there. */
const zoomed = (state, canvas, factor, [x, y] = [canvas.clientWidth / 2, canvas.clientHeight / 2]) => {
  const { scale, left, top } = paneMap(canvas, state);
  state.zoom = clamp(state.zoom * factor, 1, 64);
  const now = paneMap(canvas, state);
  look(state, state.u + ((x - left) / scale - (x - now.left) / now.scale) / state.width, state.v + ((y - top) / scale - (y - now.top) / now.scale) / state.height);
};

/** Mouse and touch on one pane. `act` changes what is seen, `flip` turns to the other picture. */
const steer = (canvas, state, act, flip) => {
  const fingers = new Map();
  let travelled = 0;
  const place = event => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
  const aim = ([px, py]) => {
    const { scale, left, top } = paneMap(canvas, state), x = Math.floor((px - left) / scale), y = Math.floor((py - top) / scale);
    if (x >= 0 && y >= 0 && x < state.width && y < state.height) state.cursor = { x, y };
  };
  /** The middle of the fingers and, of two, their distance. */
  const grip = () => {
    const [p, q = p] = [...fingers.values()];
    return { x: (p[0] + q[0]) / 2, y: (p[1] + q[1]) / 2, apart: Math.hypot(p[0] - q[0], p[1] - q[1]) };
  };
  const drag = event => {
    const was = grip(), { scale } = paneMap(canvas, state);
    fingers.set(event.pointerId, place(event));
    const { x, y, apart } = grip();
    travelled += Math.hypot(x - was.x, y - was.y) + Math.abs(apart - was.apart);
    look(state, state.u - (x - was.x) / scale / state.width, state.v - (y - was.y) / scale / state.height);
    if (was.apart > 0) zoomed(state, canvas, apart / was.apart, [x, y]);
  };
  const lift = event => {
    if (fingers.delete(event.pointerId) && !fingers.size && event.type === 'pointerup' && travelled < 5 && event.button === 0) flip();
  };
  canvas.addEventListener('pointerdown', event => {
    if (!fingers.size) travelled = 0;
    fingers.set(event.pointerId, place(event));
    canvas.setPointerCapture(event.pointerId);
    act(() => aim(place(event)));
  });
  canvas.addEventListener('pointermove', event => act(() => fingers.has(event.pointerId) ? drag(event) : aim(place(event))));
  canvas.addEventListener('pointerup', lift);
  canvas.addEventListener('pointercancel', lift);
  canvas.addEventListener('wheel', event => {
    if (event.deltaY > 0 && state.zoom === 1) return; // nothing to zoom out of: the page scrolls
    event.preventDefault();
    act(() => zoomed(state, canvas, Math.exp(-event.deltaY * (event.deltaMode ? 0.04 : 0.002)), place(event)));
  }, { passive: false });
  canvas.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const change = event.key === ' ' ? flip : keyed(event, canvas, state);
    if (!change) return;
    event.preventDefault();
    act(change);
  });
};

/** What a key does to the view, if anything. */
const keyed = ({ key, shiftKey }, canvas, state) => {
  const step = KEYS[key], factor = { '+': 1.5, '=': 1.5, '-': 1 / 1.5, 0: 0 }[key], { width, height, u, v, zoom, cursor } = state;
  if (factor !== undefined) return () => zoomed(state, canvas, factor);
  if (!step) return null;
  if (!shiftKey) return () => look(state, u + step[0] / 8 / zoom, v + step[1] / 8 / zoom);
  const { x, y } = cursor ?? { x: Math.floor(u * width) - step[0], y: Math.floor(v * height) - step[1] };
  return () => { state.cursor = { x: clamp(x + step[0], 0, width - 1), y: clamp(y + step[1], 0, height - 1) }; };
};

const drawPane = (canvas, tile, state) => {
  const ratio = window.devicePixelRatio || 1, [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
  if (!width || !height) return;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  const context = canvas.getContext('2d'), { scale, left, top } = paneMap(canvas, state);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  context.imageSmoothingEnabled = scale * ratio < 1;
  context.drawImage(tile, left, top, tile.width * scale, tile.height * scale);
  canvas.style.touchAction = state.zoom > 1 ? 'none' : 'pan-y';
  if (!state.cursor) return;
  const size = Math.max(scale, 5), shift = (size - scale) / 2;
  const [x, y] = [left + state.cursor.x * scale - shift, top + state.cursor.y * scale - shift];
  [['#000', 3], ['#fff', 1]].forEach(([colour, wide]) => { context.strokeStyle = colour; context.lineWidth = wide; context.strokeRect(x, y, size, size); });
};

const pictureSection = report => {
  const host = part('pictures'), images = pictures(report);
  if (!images.length) return host.append(aside('There are no pictures.'));
  const reference = Math.max(0, images.findIndex(image => image.name === 'reference'));
  const first = Math.max(0, images.findIndex((_, i) => i !== reference));
  const { width, height } = images[0];
  const state = { width, height, shown: [first, reference], view: 'picture', flipping: false, front: 0, exposure: 0, scale: -2, zoom: 1, u: 0.5, v: 0.5, cursor: null };
  const panes = [0, 1].map(k => {
    const canvas = el('canvas', { tabindex: 0, role: 'img', 'aria-label': `Picture ${'AB'[k]}. Plus and minus zoom, arrows move, 0 shows all, Shift and arrows read pixels, space flips.` });
    const caption = el('figcaption');
    return { canvas, caption, figure: el('figure', {}, canvas, caption), key: '', tile: null };
  });
  const both = el('div', { class: 'panes' }, panes.map(pane => pane.figure)), legend = el('div'), pixel = el('div', { class: 'pixel', role: 'status' }), zoom = el('output');
  both.style.setProperty('--aspect', width / height);

  const draw = () => {
    const focused = panes.some(pane => pane.canvas === document.activeElement);
    both.classList.toggle('one', state.flipping);
    contents(state, images).forEach((content, k) => {
      const pane = panes[k], key = [images.indexOf(content.image), images.indexOf(content.other), content.shade, state.exposure, state.scale].join();
      if (pane.key !== key) Object.assign(pane, { key, tile: painted(content, state) });
      pane.caption.textContent = (state.flipping ? `${'AB'[k]}: ` : '') + content.words;
      pane.figure.hidden = state.flipping && k !== state.front;
      if (!pane.figure.hidden) drawPane(pane.canvas, pane.tile, state);
    });
    if (focused && panes[1 - state.front].figure.hidden) panes[state.front].canvas.focus({ preventScroll: true });
    turn.hidden = !state.flipping;
    turn.textContent = `show ${'AB'[1 - state.front]}`;
    scale.hidden = state.view !== 'difference';
    zoom.textContent = `zoom ${times(state.zoom)}`;
    legend.replaceChildren(scaleLegend(state));
    pixel.replaceChildren(pixelWords(state, images));
  };
  let waiting = false;
  const act = change => {
    change();
    if (!waiting) requestAnimationFrame(() => { waiting = false; draw(); });
    waiting = true;
  };
  const set = (key, value) => act(() => { state[key] = value; });
  const flip = () => set('front', state.flipping ? 1 - state.front : state.front);
  const centre = factor => act(() => zoomed(state, panes[state.flipping ? state.front : 0].canvas, factor));
  const turn = button('show B', flip);
  const scale = slider('Full colour at', -10, 6, 0.5, state.scale, value => short(2 ** value), value => set('scale', value));
  const menu = k => {
    const select = el('select', {}, images.map((image, i) => el('option', { value: i, selected: state.shown[k] === i }, image.name)));
    select.addEventListener('change', () => act(() => { state.shown[k] = Number(select.value); }));
    return el('label', {}, 'AB'[k], select);
  };
  host.append(el('div', { class: 'set' },
    el('div', { class: 'controls' },
      choice('View', [['picture', 'picture'], ['difference', 'A − B'], ['error', 'error map']], view => set('view', view)),
      choice('Layout', [[false, 'two panes'], [true, 'flip']], flipping => set('flipping', flipping)), turn),
    el('div', { class: 'controls' }, button('−', () => centre(1 / 1.5), 'Zoom out'), button('+', () => centre(1.5), 'Zoom in'), button('all', () => centre(0), 'Show all'), zoom,
      slider('Exposure', -8, 8, 0.25, 0, stops, value => set('exposure', value)), scale),
    el('div', { class: 'menus' }, menu(0), menu(1)), both, legend, pixel,
    el('p', { class: 'aside help' }, 'Wheel or pinch zooms, dragging moves. Keys on a pane: + − arrows, 0 for all, space flips. Magenta: a value is not finite.')));
  panes.forEach(pane => steer(pane.canvas, state, act, flip));
  new ResizeObserver(() => act(() => {})).observe(both);
  draw();
};

// ---- The page ----
const parsed = () => {
  try { return JSON.parse(document.getElementById('report').textContent) ?? {}; } catch { return {}; }
};

const report = parsed();
for (const section of [facts, headline, errorSection, priceSection, knobSection, timeSection, pyramidSection, planSection, pictureSection]) section(report);
})();
