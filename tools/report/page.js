// Draws the visible figures in the colours of the page. Repeats it if the reader switches between light and dark, unfolds
// a section, or prints.
(function () {
  'use strict';
  const figures = new Map(JSON.parse(document.getElementById('figures').textContent).map((figure) => [figure.id, figure]));
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const drawn = new Set();

  // WCAG 2: relative brightness of a colour, and contrast of two brightnesses
  const brightness = (rgb) => {
    const [r, g, b] = rgb.map((c) => (c / 255 <= 0.03928 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const contrast = (a, b) => (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  const hexOf = (rgb) => '#' + rgb.map((c) => Math.round(c).toString(16).padStart(2, '0')).join('');
  const rgbOf = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));

  // lightens a colour until it stands out from the dark ground of a plot (contrast of at least 3)
  function lightened(hex) {
    const ground = brightness(rgbOf(colour('--card')));
    let rgb = rgbOf(hex);
    for (let k = 0; k < 20 && contrast(brightness(rgb), ground) < 3; ++k) rgb = rgb.map((c) => c + 0.1 * (255 - c));
    return hexOf(rgb);
  }
  const paper = () => document.documentElement.classList.contains('paper');
  const shown = (value) => {
    if (!dark.matches || paper()) return value;
    if (typeof value === 'string') return /^#[0-9a-f]{6}$/i.test(value) ? lightened(value) : value;
    if (Array.isArray(value)) return typeof value[0] === 'number' ? value : value.map(shown);
    if (value === null || typeof value !== 'object') return value;
    return Object.fromEntries(Object.entries(value).map(([key, inner]) => [key, shown(inner)]));
  };

  function themed(layout, width, height) {
    const axis = { gridcolor: colour('--rule'), linecolor: colour('--rule'), zerolinecolor: colour('--rule'), automargin: true };
    const narrow = width < 520;
    const base = {
      paper_bgcolor: 'rgba(0,0,0,0)', plot_bgcolor: 'rgba(0,0,0,0)',
      margin: narrow ? { l: 48, r: 8, t: 12, b: 40 } : { l: 64, r: 20, t: 18, b: 48 },
      font: { family: getComputedStyle(document.body).fontFamily, size: narrow ? 11 : 13, color: colour('--ink') },
      legend: narrow ? { orientation: 'h', yref: 'container', y: 0, yanchor: 'bottom', x: 0, maxheight: 0.7 } : { orientation: 'h', y: 1.0, yanchor: 'bottom', x: 0, maxheight: 0.7 },
      dragmode: narrow ? false : 'zoom',
    };
    const axes = { xaxis: {}, yaxis: {} };
    for (const name of Object.keys(layout)) if (/^[xy]axis/.test(name)) axes[name] = layout[name];
    // between decades Plotly writes only the digit ("5" for 0.05), which is misleading
    const logarithmic = (name) => ({ tickformat: '~g', nticks: Math.max(3, Math.round((name[0] === 'y' ? height : width) / 90)) });
    // a long title would be cut off at a short axis: only the unit is shown, and the caption contains the name
    const shortened = (name, title) => {
      const most = name[0] === 'y' ? 20 : 44;
      const unit = narrow && title && title.text.length > most ? /\[[^\]]*\]$/.exec(title.text) : null;
      return unit ? { title: Object.assign({}, title, { text: unit[0] }) } : {};
    };
    for (const name of Object.keys(axes))
      axes[name] = Object.assign({}, axis, axes[name].type === 'log' ? logarithmic(name) : {}, axes[name], shortened(name, axes[name].title));
    return Object.assign(base, layout, axes);
  }

  // a legend with many names gets extra height, which Plotly would take from the plot
  function fit(element) {
    element.style.height = '';
    const width = element.clientWidth, names = figures.get(element.id).data.filter((trace) => trace.name && trace.showlegend !== false);
    if (width === 0) return;
    const longest = Math.max(0, ...names.map((trace) => trace.name.length));
    const columns = Math.max(1, Math.floor((width - 84) / (48 + (width < 520 ? 6.2 : 7.2) * longest)));
    const rows = Math.ceil(names.length / columns);
    if (rows > 2) element.style.height = `${element.clientHeight + 19 * (rows - 2)}px`;
  }

  function draw(element) {
    const figure = figures.get(element.id);
    drawn.add(element);
    fit(element);
    const layout = Object.assign(themed(figure.layout, element.clientWidth, element.clientHeight), { width: element.clientWidth, height: element.clientHeight });
    Plotly.react(element, shown(figure.data), layout, { displaylogo: false, displayModeBar: false });
    document.documentElement.dataset.drawn = String(drawn.size);
  }

  const plots = [...document.querySelectorAll('.plot')].filter((element) => figures.has(element.id));
  const visible = (element) => element.clientWidth > 0;
  // folded figures are drawn when they become visible
  const again = () => [...drawn].forEach((element) => visible(element) ? draw(element) : drawn.delete(element));

  // each figure is drawn shortly before it becomes visible, because a page may have many
  const watcher = new IntersectionObserver((entries) => {
    for (const entry of entries) if (entry.isIntersecting && !drawn.has(entry.target)) draw(entry.target);
  }, { rootMargin: '600px' });
  plots.forEach((element) => { fit(element); watcher.observe(element); });
  dark.addEventListener('change', again);
  let waiting = 0;
  window.addEventListener('resize', () => { clearTimeout(waiting); waiting = setTimeout(again, 120); });

  // unfolds the target of a link, and everything for printing
  function named() {
    try { return document.getElementById(decodeURIComponent(location.hash.slice(1))); } catch { return null; }  // "#100%"
  }
  function unfold() {
    let at = location.hash.length > 1 ? named() : null;
    for (const target = at; at; at = at.parentElement) {
      if (at.tagName === 'DETAILS' && !at.open) { at.open = true; target.scrollIntoView(); }
    }
  }
  window.addEventListener('hashchange', unfold);
  unfold();
  let folded = [];
  window.addEventListener('beforeprint', () => {
    folded = [...document.querySelectorAll('details:not([open])')];
    folded.forEach((part) => { part.open = true; });
    document.documentElement.classList.add('paper');
    plots.forEach(draw);
  });
  window.addEventListener('afterprint', () => {
    folded.forEach((part) => { part.open = false; });
    document.documentElement.classList.remove('paper');
    again();
  });
  document.documentElement.dataset.state = 'drawn';
})();
