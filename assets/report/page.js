'use strict';
// The curves of the test. Both graphs show the same time. A dot, a row and a curve of one model are highlighted together.
(() => {
  const data = JSON.parse(document.getElementById('curves-data').textContent);
  const place = id => document.getElementById(id);
  if (!window.Dygraph || !data.models) return;
  document.body.classList.add('live');
  const names = data.models.map(model => model.name);
  const colours = data.models.map(model => model.colour);
  const graphs = [];
  const table_rows = name => [...document.querySelectorAll('.headline tbody tr')].filter(
      row => row.cells[0].firstChild.textContent.split(' = ').includes(name));
  const mark = name => {
    for (const row of document.querySelectorAll('tr.marked')) row.classList.remove('marked');
    for (const row of table_rows(name)) row.classList.add('marked');
  };
  const highlight = name => {
    mark(name);
    for (const graph of graphs) {
      if (names.includes(name)) graph.setSelection(graph.numRows() >> 1, name, true); else graph.clearSelection();
    }
  };
  // Both graphs zoom together; each draw of one would ask the other to draw again.
  let following = false;
  const follow = (graph, first) => {
    if (following || first) return;
    following = true;
    const range = graph.xAxisRange();
    for (const other of graphs) if (other !== graph) other.updateOptions({dateWindow: range});
    following = false;
  };
  const show = (id, first_column, labels, colors, ylabel, band) => graphs.push(new Dygraph(place(id),
      data.rows.map(row => [row[0], ...row.slice(first_column, first_column + labels.length)]), {
        labels: ['time', ...labels], colors, ylabel, legend: 'never', strokeWidth: 1.2, highlightCircleSize: 2,
        highlightSeriesOpts: {strokeWidth: 2.6}, drawCallback: follow, axisLabelFontSize: 11, yLabelWidth: 14,
        xlabel: band ? 'Time [s]' : '', gridLineColor: getComputedStyle(document.body).getPropertyValue('--grid'),
        axes: {x: {pixelsPerLabel: 70}}, highlightCallback: (event, x, points, row, name) => mark(name),
        unhighlightCallback: () => mark(),
        underlayCallback: (canvas, area, graph) => {
          if (!band) return;
          const [top, bottom] = [graph.toDomYCoord(1), graph.toDomYCoord(-1)];
          canvas.fillStyle = getComputedStyle(document.body).getPropertyValue('--band');
          canvas.fillRect(area.x, top, area.w, bottom - top);
        }}));
  show('curves-force', 1, ['measured', ...names], ['#009E73', ...colours], 'Force [N]', false);
  show('curves-difference', names.length + 2, names, colours, 'Difference [JND]', true);
  place('curves-measured').textContent = 'Measured: ' + data.recording + '.';
  place('curves-measured').style.color = '#009E73';
  const buttons = place('curves-worst');
  for (const model of data.models) {
    const button = document.createElement('button');
    button.textContent = model.name;
    button.style.borderBottomColor = model.colour;
    button.onmouseenter = () => highlight(model.name);
    button.onmouseleave = () => highlight();
    button.onclick = () => {
      for (const graph of graphs) graph.updateOptions({dateWindow: [model.worst_s - 0.15, model.worst_s + 0.15]});
      place('curves-said').textContent = model.said;
    };
    buttons.append(button);
    for (const row of table_rows(model.name)) {
      row.onmouseenter = () => highlight(model.name);
      row.onmouseleave = () => highlight();
    }
  }
  for (const [plot, name] of data.dots) {
    const dot = place('speed_error-gnuplot_plot_' + plot + 'a');
    if (!dot) continue;
    dot.style.cursor = 'pointer';
    dot.onmouseenter = () => highlight(name);
    dot.onmouseleave = () => highlight();
  }
})();
