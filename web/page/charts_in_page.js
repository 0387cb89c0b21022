// Puts each chart where its picture stands.
import { mount } from '../charts/charts.js';

export function mountCharts(charts, onTouch) {
  for (const { id, height, option } of charts) {
    const figure = document.getElementById(id);
    const picture = figure.querySelector('svg');
    const place = document.createElement('div');
    place.className = 'chart-place';
    picture.replaceWith(place);
    const chart = mount(place, option, height);
    chart.on('click', ({ data }) => {
      if (data && data.touch !== undefined) onTouch(data.touch);
    });
    new ResizeObserver(() => chart.resize()).observe(place);
    // A page is printed at another width than it has on the screen.
    window.addEventListener('beforeprint', () => chart.resize({ width: 680 }));
    window.addEventListener('afterprint', () => chart.resize({ width: 'auto' }));
  }
}
