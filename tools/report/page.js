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
    return Object.assign(base, layout, { xaxis: Object.assign({}, axis, layout.xaxis), yaxis: Object.assign({}, axis, layout.yaxis) });
  }

  function draw() {
    for (const figure of figures) {
      Plotly.react(figure.id, figure.data, themed(figure.layout), { responsive: true, displaylogo: false, displayModeBar: false });
    }
  }
  draw();
  dark.addEventListener('change', draw);
})();
