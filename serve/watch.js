// SPDX-License-Identifier: Apache-2.0
// Asks for the figures of a run, or of a folder of runs, each second, and shows them. Nothing that comes from files is
// taken for HTML.
'use strict';

const asked = new URLSearchParams(location.search);
const run = asked.get('run') || '';
if (asked.has('token')) {  // a cookie has it now; a URL is shown and copied
  asked.delete('token');
  history.replaceState(null, '', location.pathname + (asked.toString() ? '?' + asked : ''));
}

// ---- making elements and texts ----

function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) element[name] = value;
  element.append(...children.filter(child => child !== null && child !== ''));
  return element;
}

const known = value => typeof value === 'number' && isFinite(value);
const precise = (value, digits = 3) => known(value) ? String(+value.toPrecision(digits)) : '';
const percent = value => known(value) ? precise(100 * value) + ' %' : '';

// As in the terminal: "7.1 s", "1:40", "2:30:00", "3 days".
function duration(seconds) {
  if (!known(seconds)) return '';
  if (seconds < 59.5) return precise(seconds, 2) + ' s';
  const whole = Math.round(seconds), two = number => String(number % 60).padStart(2, '0');
  const minutes = Math.floor(whole / 60);
  if (whole < 3600) return minutes + ':' + two(whole);
  if (whole < 48 * 3600) return Math.floor(minutes / 60) + ':' + two(minutes) + ':' + two(whole);
  return Math.round(whole / 86400) + ' days';
}

function large(value) {
  if (!known(value)) return '';
  for (const [unit, factor] of [['G', 1e9], ['M', 1e6], ['k', 1e3]])
    if (value >= factor) return precise(value / factor) + ' ' + unit;
  return precise(value);
}

const kStateWords = {silent: 'silent: nothing heard for a minute', killed: 'killed: its process is gone'};
const badge = state => make('span', {className: 'state ' + state, textContent: kStateWords[state] || state});

// ---- what a run says of itself ----

const isLive = view => view.state === 'running';

function factsOf(view) {
  const error = known(view.error) ? 'error ' + percent(view.error) : '';
  const interval = known(view.error_low) && known(view.error_high)
    ? ` (${percent(view.error_low)} to ${percent(view.error_high)})` : '';
  return [
    known(view.pass) && isLive(view) ? 'pass ' + view.pass + (view.passes > 0 ? '/' + view.passes : '') : '',
    known(view.spp_done) ? view.spp_done + (isLive(view) && view.spp > 0 ? ' of ' + view.spp : '') + ' spp' : '',
    error + (error && interval),
    known(view.elapsed_seconds) ? duration(view.elapsed_seconds) + (isLive(view) ? ' so far' : '') : '',
    isLive(view) && view.seconds_left > 0 ? 'about ' + duration(view.seconds_left) + ' left' : '',
    isLive(view) && known(view.workers) ? view.workers + (view.workers === 1 ? ' worker' : ' workers') : '',
  ].filter(text => text).join(' · ');
}

const pictureAddress = view =>
  'preview.png?' + new URLSearchParams({run: view.run, v: view.picture});

// Shows a picture in the place of another once it has come whole.
function showPicture(box, view) {
  if (box.dataset.version === (view.picture || '')) return;
  box.dataset.version = view.picture || '';
  if (!view.picture) {
    box.replaceChildren(make('div', {className: 'none', textContent: 'no picture yet'}));
    return;
  }
  const image = make('img', {alt: 'the image of ' + view.title + ' so far', src: pictureAddress(view)});
  const version = view.picture;
  image.addEventListener('load', () => { if (box.dataset.version === version) box.replaceChildren(image); });
  image.addEventListener('error', () => { if (box.dataset.version === version) box.dataset.version = 'none'; });
}

function progressBar(view) {
  const bar = make('progress', {max: 1});
  if (!isLive(view) || view.fraction > 0) bar.value = known(view.fraction) ? view.fraction : 0;
  bar.setAttribute('aria-label', 'progress');
  return bar;
}

function table(heads, rows) {
  const cell = (tag, value, index) => make(tag, {className: heads[index].text ? 'text' : ''}, value instanceof Node ? value : String(value));
  return make('div', {className: 'wide'}, make('table', {},
    make('thead', {}, make('tr', {}, ...heads.map((head, k) => cell('th', head.name, k)))),
    make('tbody', {}, ...rows.map(row => make('tr', {}, ...row.map((value, k) => cell('td', value, k)))))));
}

// Fraction of their processors that busy threads got; marked where other programs took most of the rest.
function share(value) {
  if (!known(value)) return '';
  const text = Math.round(100 * value) + ' %';
  return value < 0.5 ? make('strong', {textContent: 'had ' + text, title: 'Other programs use its processors, or it has more threads than processors.'}) : text;
}

function workersOf(view) {
  const farm = view.farm;
  if (!farm || farm.workers.length === 0) return null;
  const heads = ['worker', 'state', 'paths/s', 'idle', 'processors', 'losses', 'threads', 'host'].map(name => ({name, text: name === 'host' || name === 'state'}));
  const rows = farm.workers.map(worker => [known(worker.worker) ? worker.worker : '', badge(worker.state || 'unknown'),
    worker.state === 'present' ? large(worker.paths_per_second) : '', known(worker.idle_share) ? Math.round(100 * worker.idle_share) + ' %' : '',
    share(worker.processor_share), worker.losses || '', known(worker.threads) ? worker.threads : '', worker.host || '']);
  const counts = [['reissued_units', 'units issued again'], ['copied_units', 'units copied for who was idle'],
    ['dropped_results', 'results too late to count'], ['bad_messages', 'bad messages']]
    .filter(([key]) => farm[key] > 0).map(([key, words]) => farm[key] + ' ' + words).join(' · ');
  return make('section', {id: 'workers'}, make('h2', {textContent: 'Workers'}), table(heads, rows),
    make('p', {className: 'note', textContent: counts}));
}

function passesOf(view) {
  if (view.table.length === 0) return null;
  const heads = ['pass', 'spp', 'in all', 'seconds', 'error', 'rays/s', 'idle', 'workers'].map(name => ({name}));
  const rows = view.table.slice().reverse().map(pass => [pass.pass, pass.spp, pass.spp_done, precise(pass.seconds), percent(pass.error),
    large(pass.rays_per_second), pass.seconds > 0 && pass.threads > 0 ? Math.round(100 * pass.idle_seconds / (pass.seconds * pass.threads)) + ' %' : '',
    known(pass.workers) ? pass.workers : '']);
  return make('section', {id: 'passes'}, make('h2', {textContent: 'Passes, the last first'}), table(heads, rows));
}

// ---- error over time ----

// Round values of a logarithmic axis, as fine as `most` allows.
function ticks(low, high, most) {
  let found = [];
  for (const steps of [[1, 2, 5], [1, 3], [1]]) {
    found = [];
    for (let decade = Math.floor(Math.log10(low)); decade <= Math.ceil(Math.log10(high)); ++decade)
      for (const step of steps) {
        const value = step * Math.pow(10, decade);
        if (value >= low * 0.999 && value <= high * 1.001) found.push(value);
      }
    if (found.length <= most) return found;
  }
  return found.filter((value, k) => k % Math.ceil(found.length / most) === 0);
}

function drawChart(box, view) {
  const points = view.table.filter(pass => pass.error > 0 && pass.run_seconds > 0);
  if (points.length === 0) {
    box.replaceChildren(make('p', {className: 'note', textContent: 'The error is known after the first passes.'}));
    return;
  }
  const last = points[points.length - 1];
  const ahead = [['half the error', view.halving], ['the error asked for', view.target]]
    .filter(([, forecast]) => forecast && forecast.relative_error > 0 && known(forecast.seconds) && forecast.seconds > 0 && (isLive(view) || forecast === view.halving))
    .map(([words, forecast]) => ({words, x: last.run_seconds + forecast.seconds, y: forecast.relative_error, trust: forecast.trust || '', seconds: forecast.seconds}));
  const xs = points.map(p => p.run_seconds).concat(ahead.map(p => p.x));
  const ys = points.flatMap(p => [p.error, p.error_low > 0 ? p.error_low : p.error, p.error_high > 0 ? p.error_high : p.error]).concat(ahead.map(p => p.y));
  const width = Math.max(260, Math.round(box.clientWidth)), height = Math.round(Math.min(340, 0.7 * width));
  const left = 52, right = 14, top = 10, bottom = 34;
  const spread = (values, margin) => [Math.min(...values) / margin, Math.max(...values) * margin];
  const [x0, x1] = spread(xs, 1.15), [y0, y1] = spread(ys, 1.25);
  const x = v => left + (width - left - right) * Math.log(v / x0) / Math.log(x1 / x0);
  const y = v => height - bottom - (height - top - bottom) * Math.log(v / y0) / Math.log(y1 / y0);
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  const draw = (tag, attributes, text) => {
    const element = document.createElementNS(svg.namespaceURI, tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    if (text !== undefined) element.textContent = text;
    svg.append(element);
  };
  svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
  svg.setAttribute('role', 'img');
  draw('title', {}, 'Relative error over seconds of rendering, both logarithmic');
  for (const value of ticks(x0, x1, width / 65)) {
    draw('line', {class: 'grid', x1: x(value), x2: x(value), y1: top, y2: height - bottom});
    const label = duration(value), half = 3.5 * label.length;  // of a label near the edge, all must be seen
    draw('text', {x: Math.min(x(value), width - half), y: height - bottom + 15, 'text-anchor': 'middle'}, label);
  }
  for (const value of ticks(y0, y1, height / 28)) {
    draw('line', {class: 'grid', x1: left, x2: width - right, y1: y(value), y2: y(value)});
    draw('text', {x: left - 6, y: y(value) + 4, 'text-anchor': 'end'}, percent(value));
  }
  const within = points.filter(p => p.error_low > 0 && p.error_high > 0);
  if (within.length > 1)
    draw('polygon', {class: 'band', points: within.map(p => `${x(p.run_seconds)},${y(p.error_low)}`)
      .concat(within.slice().reverse().map(p => `${x(p.run_seconds)},${y(p.error_high)}`)).join(' ')});
  draw('polyline', {class: 'curve', points: points.map(p => `${x(p.run_seconds)},${y(p.error)}`).join(' ')});
  for (const p of points) draw('circle', {class: 'dot', cx: x(p.run_seconds), cy: y(p.error), r: 3});
  for (const p of ahead) {
    draw('line', {class: 'forecast', x1: x(last.run_seconds), y1: y(last.error), x2: x(p.x), y2: y(p.y)});
    draw('circle', {class: 'goal', cx: x(p.x), cy: y(p.y), r: 4});
  }
  box.replaceChildren(svg, ...ahead.map(p => make('p', {className: 'note',
    textContent: `Dashed: ${p.words}, ${percent(p.y)}, in ${duration(p.seconds)} more` + (p.trust && p.trust !== 'firm' ? ` (${p.trust})` : '')})));
}

// ---- the two pages ----

// Parts of a page that stay, so that what has not changed does not flicker and a log keeps its place.
let parts = null;

function buildRun(main) {
  parts = {
    head: make('div'), picture: make('div', {className: 'picture'}), chart: make('div', {id: 'chart'}),
    workers: make('div'), passes: make('div'), log: make('pre', {id: 'log', tabIndex: 0}), end: make('div'),
  };
  main.replaceChildren(...(run ? [make('p', {}, make('a', {href: './', textContent: '← all runs'}))] : []), parts.head,
    make('div', {className: 'two'}, parts.picture, make('section', {}, make('h2', {textContent: 'Error over time'}), parts.chart)),
    parts.workers, parts.passes, make('h2', {textContent: 'Log'}), parts.log, parts.end);
}

function replaceIfNew(box, name, value, content) {
  const text = JSON.stringify(value);
  if (box.dataset[name] === text) return;
  box.dataset[name] = text;
  box.replaceChildren(...[content()].flat().filter(child => child !== null));
}

function showRun(view) {
  document.title = (isLive(view) && view.fraction > 0 ? Math.floor(100 * view.fraction) + ' % ' : '') + view.title + ' · Treefarm';
  document.getElementById('title').replaceChildren(view.title + ' ', badge(view.state));
  const launch = view.launch && view.launch.phase && isLive(view) ? `treefarm launch: ${view.launch.phase}, on ${view.launch.host || '?'}` : '';
  parts.head.replaceChildren(progressBar(view), make('p', {id: 'facts', className: 'facts', textContent: factsOf(view)}),
    launch ? make('p', {className: 'note', textContent: launch}) : '',
    view.message ? make('p', {className: 'message', textContent: view.message}) : '');
  showPicture(parts.picture, view);
  const width = parts.chart.clientWidth;
  if (parts.chart.dataset.shown !== JSON.stringify([view.table, view.halving, view.target, view.state, width])) {
    parts.chart.dataset.shown = JSON.stringify([view.table, view.halving, view.target, view.state, width]);
    drawChart(parts.chart, view);
  }
  replaceIfNew(parts.workers, 'shown', view.farm, () => workersOf(view));
  replaceIfNew(parts.passes, 'shown', view.table, () => passesOf(view));
  const log = view.log.join('\n');
  if (parts.log.textContent !== log) {
    const atEnd = parts.log.scrollHeight - parts.log.scrollTop - parts.log.clientHeight < 40 || !parts.log.textContent;
    parts.log.textContent = log;
    if (atEnd) parts.log.scrollTop = parts.log.scrollHeight;
  }
  replaceIfNew(parts.end, 'shown', [view.image_hash, view.command], () => [
    view.image_hash ? make('p', {className: 'note', textContent: `image ${view.image_hash}, ${view.width} x ${view.height}`}) : null,
    view.command ? make('p', {className: 'note', textContent: view.command}) : null]);
}

function showList(list) {
  document.title = 'Runs · Treefarm';
  document.getElementById('title').textContent = 'Runs';
  const old = parts.cards;
  parts.cards = new Map();
  for (const view of list.runs) {
    const card = old.get(view.run) || make('a', {className: 'card', href: '?' + new URLSearchParams({run: view.run})},
      make('div', {className: 'picture-of'}), make('div'));
    parts.cards.set(view.run, card);
    showPicture(card.firstChild, view);
    replaceIfNew(card.lastChild, 'shown', view, () => [make('b', {textContent: view.run}), badge(view.state), progressBar(view),
      make('p', {className: 'facts', textContent: factsOf(view)})]);
  }
  const order = [...parts.cards.values()];
  if (order.some((card, k) => parts.grid.children[k] !== card) || parts.grid.children.length !== order.length) parts.grid.replaceChildren(...order);
  parts.note.textContent = list.runs.length === 0 ? `There is no run in ${list.folder} yet; this page shows one as soon as it begins.`
    : list.folder + (list.left_out ? ` · ${list.left_out} older runs are left out` : '');
}

function show(answer) {
  const main = document.getElementById('main');
  if (!parts && answer.kind === 'run') buildRun(main);
  if (!parts) {
    parts = {cards: new Map(), grid: make('div', {className: 'cards'}), note: make('p', {className: 'note'})};
    main.replaceChildren(parts.note, parts.grid);
  }
  if ((answer.kind === 'run') !== ('head' in parts)) location.reload();  // the folder has become a run
  else if (answer.kind === 'run') showRun(answer);
  else showList(answer);
}

function notice(text) {
  const element = document.getElementById('notice');
  element.hidden = !text;
  if (element.textContent !== text) element.textContent = text;
}

async function ask() {
  const answer = await fetch('status.json' + (run ? '?' + new URLSearchParams({run}) : ''), {cache: 'no-store'});
  if (answer.ok) return answer.json();
  throw new Error((await answer.text()).trim());
}

async function watch() {
  let pause = 1000;
  for (let trouble = ''; ; await new Promise(done => setTimeout(done, pause))) {
    if (document.hidden) continue;
    try {
      const answer = await ask();
      show(answer);
      trouble = '';
      // What has ended changes no more, unless somebody goes on with it.
      pause = answer.kind === 'run' && !isLive(answer) ? 3000 : 1000;
    } catch (error) {
      trouble = error instanceof TypeError ? 'treefarm serve does not answer; asking again ...' : error.message;
      pause = 3000;
    }
    notice(trouble);
  }
}

watch();
