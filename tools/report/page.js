// Draws the figures of the page in the page's own colours, and again when the reader changes between light and dark.
(function () {
  'use strict';
  const figures = JSON.parse(document.getElementById('figures').textContent);
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  function themed(layout) {
    const axis = { gridcolor: colour('--rule'), linecolor: colour('--rule'), zerolinecolor: colour('--rule'), automargin: true };
    const base = {
      paper_bgcolor: 'rgba(0,0,0,0)', plot_bgcolor: 'rgba(0,0,0,0)', margin: { l: 64, r: 20, t: 18, b: 48 },
      font: { family: getComputedStyle(document.body).fontFamily, size: 13, color: colour('--ink') },
      legend: { orientation: 'h', y: 1.0, yanchor: 'bottom', x: 0 },
    };
    const axes = { xaxis: {}, yaxis: {} };
    for (const name of Object.keys(layout)) if (/^[xy]axis/.test(name)) axes[name] = layout[name];
    for (const name of Object.keys(axes)) axes[name] = Object.assign({}, axis, axes[name]);
    return Object.assign(base, layout, axes);
  }

  function draw() {
    for (const figure of figures) {
      Plotly.react(figure.id, figure.data, themed(figure.layout), { responsive: true, displaylogo: false, displayModeBar: false });
    }
  }
  draw();
  dark.addEventListener('change', draw);
})();
