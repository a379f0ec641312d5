// Appended to a page by report_test, which shows it in a frame: checks it in a real browser and tells the result.
(() => {
  const wrong = [...window.messages];
  const expect = (holds, what) => { if (!holds) wrong.push(what); };
  const all = selector => [...document.querySelectorAll(selector)];
  expect(document.documentElement.scrollWidth <= innerWidth, 'the page is wider than the window');
  for (const table of all('.headline .table'))
    expect(table.scrollWidth <= table.clientWidth + 1, 'the first table is cut');
  // Names and labels of a figure do not overlap each other and are not cut.
  for (const svg of all('figure svg')) {
    const edge = svg.getBoundingClientRect();
    if (edge.width === 0) continue;
    const boxes = [...svg.querySelectorAll('text')].map(text => [text.textContent, text.getBoundingClientRect()]);
    boxes.forEach(([text, box], i) => {
      expect(box.left >= edge.left - 1 && box.right <= edge.right + 1, text + ' is cut');
      for (const [other, there] of boxes.slice(0, i)) {
        const wide = Math.min(box.right, there.right) - Math.max(box.left, there.left);
        const high = Math.min(box.bottom, there.bottom) - Math.max(box.top, there.top);
        expect(wide < 2 || high < 0.4 * Math.min(box.height, there.height), text + ' overlaps ' + other);
      }
    });
  }
  const canvas = all('#curves-force canvas').pop();
  if (canvas) {
    const labels = () => all('#curves-difference .dygraph-axis-label-x').map(label => label.textContent).join();
    const box = canvas.getBoundingClientRect();
    const mouse = (type, x, to) => to.dispatchEvent(new MouseEvent(type, {
      bubbles: true, clientX: box.left + x * box.width, clientY: box.top + box.height / 2, view: window, detail: 1}));
    const before = labels();
    mouse('mousedown', 0.4, canvas);
    mouse('mousemove', 0.6, document);
    mouse('mouseup', 0.6, document);
    expect(labels() !== before, 'a zoom of one graph does not move the other');
    const dot = JSON.parse(document.getElementById('curves-data').textContent).dots[0];
    const drawn = document.getElementById('speed_error-gnuplot_plot_' + dot[0] + 'a');
    if (drawn) drawn.dispatchEvent(new MouseEvent('mouseenter'));
    expect(all('tr.marked').length === 1, 'a dot does not highlight its row');
    all('#curves-worst button')[0].click();
    expect(document.getElementById('curves-said').textContent.includes('errs most'), 'no jump to the worst');
  } else {
    expect(!document.getElementById('curves-data'), 'no curves');
  }
  parent.postMessage(location.pathname.split('/').at(-2) + ' ' + innerWidth + ': ' + (wrong.join('; ') || 'right'), '*');
})();
