#include "optimisation/report/page_assets.h"

namespace kingpin::report {

std::string_view GetPageScript() {
  return R"js(
'use strict';
(function () {
  const root = document.documentElement;
  root.classList.add('js');

  // A value read from the drawing, with no more digits than a tenth of a pixel carries.
  function show(axis, pixel) {
    const v = toValue(axis, pixel), a = Math.abs(v);
    if (!isFinite(v)) return '–';
    let s;
    if (axis[4] || a >= 1e6) {
      s = a >= 1e6 || a < 1e-4 ? a.toExponential(2) : String(+a.toPrecision(3));
    } else {
      const step = 0.1 * Math.abs((axis[3] - axis[2]) / (axis[1] - axis[0]));
      s = a.toFixed(Math.min(12, Math.max(0, Math.floor(-Math.log10(step)))));
    }
    return (v < 0 && +s !== 0 ? '−' : '') + s;
  }
  function toValue(axis, pixel) {
    const share = (pixel - axis[0]) / (axis[1] - axis[0]);
    return axis[4] ? axis[2] * Math.pow(axis[3] / axis[2], share) : axis[2] + share * (axis[3] - axis[2]);
  }
  function toPixel(axis, value) {
    const share = axis[4] ? Math.log(value / axis[2]) / Math.log(axis[3] / axis[2])
                          : (value - axis[2]) / (axis[3] - axis[2]);
    return axis[0] + share * (axis[1] - axis[0]);
  }

  // Values under the pointer, read from the drawn lines.
  function addReadout(svg) {
    const ax = JSON.parse(svg.dataset.x), ay = JSON.parse(svg.dataset.y);
    const ay2 = svg.dataset.y2 ? JSON.parse(svg.dataset.y2) : ay;
    let lines = null, cursor = null, tip = null;
    function prepare() {
      lines = Array.from(svg.querySelectorAll('path.ln[data-name]')).map(function (p) {
        const numbers = (p.getAttribute('d').match(/-?[\d.]+/g) || []).map(Number);
        const points = [];
        for (let i = 0; i + 1 < numbers.length; i += 2) points.push([numbers[i], numbers[i + 1]]);
        return {name: p.dataset.name, colour: p.getAttribute('stroke'), axis: p.dataset.right ? ay2 : ay, points: points};
      });
      cursor = document.createElementNS(svg.namespaceURI, 'line');
      cursor.setAttribute('class', 'cursor');
      cursor.setAttribute('y1', ay[0]);
      cursor.setAttribute('y2', ay[1]);
      svg.appendChild(cursor);
      tip = document.createElement('div');
      tip.className = 'tip';
      svg.parentNode.appendChild(tip);
    }
    function hide() {
      if (tip) { tip.style.display = 'none'; cursor.style.display = 'none'; }
    }
    svg.addEventListener('pointerleave', hide);
    svg.addEventListener('pointermove', function (event) {
      const box = svg.getBoundingClientRect();
      const px = (event.clientX - box.left) * svg.viewBox.baseVal.width / box.width;
      if (px < Math.min(ax[0], ax[1]) || px > Math.max(ax[0], ax[1])) { hide(); return; }
      if (!lines) prepare();
      tip.textContent = '';
      const head = document.createElement('div');
      head.textContent = (svg.dataset.xname || 'x') + ': ' + show(ax, px);
      tip.appendChild(head);
      lines.forEach(function (line) {
        let best = null, distance = 4;
        line.points.forEach(function (p) {
          const d = Math.abs(p[0] - px);
          if (d < distance) { distance = d; best = p; }
        });
        if (!best) return;
        const row = document.createElement('div'), swatch = document.createElement('i');
        swatch.style.background = line.colour;
        row.appendChild(swatch);
        row.appendChild(document.createTextNode(line.name + ': ' + show(line.axis, best[1]) +
          (line.axis === ay && svg.dataset.yname ? ' ' + svg.dataset.yname : '')));
        tip.appendChild(row);
      });
      cursor.style.display = '';
      cursor.setAttribute('x1', px);
      cursor.setAttribute('x2', px);
      tip.style.display = 'block';
      const figure = svg.parentNode.getBoundingClientRect();
      const x = event.clientX - figure.left;
      tip.style.left = (x + 14 + tip.offsetWidth > figure.width ? x - tip.offsetWidth - 10 : x + 14) + 'px';
      tip.style.top = (event.clientY - figure.top + 12) + 'px';
    });
  }
  document.querySelectorAll('svg[data-x]').forEach(addReadout);

  // Animation of the corner seen from above; x points up, y to the left.
  function springPath(ax, ay, gx, gy) {
    const n = 8, dx = gx - ax, dy = gy - ay, length = Math.hypot(dx, dy) || 1;
    const nx = -dy / length * 5, ny = dx / length * 5;
    let d = 'M' + ax.toFixed(1) + ',' + ay.toFixed(1);
    for (let i = 1; i < n; ++i) {
      const s = 0.15 + 0.7 * (i - 0.5) / (n - 1), side = i % 2 ? 1 : -1;
      d += 'L' + (ax + s * dx + side * nx).toFixed(1) + ',' + (ay + s * dy + side * ny).toFixed(1);
    }
    return d + 'L' + gx.toFixed(1) + ',' + gy.toFixed(1);
  }
  function animate(box) {
    const data = JSON.parse(box.querySelector('script[type="application/json"]').textContent);
    const svg = box.querySelector('svg.top'), plot = box.querySelector('svg[data-x]');
    const play = box.querySelector('button'), slider = box.querySelector('input.time');
    const gain = box.querySelector('input.gain'), out = box.querySelector('output');
    const frames = data.t.length;
    let cursor = null, axis = null;
    if (plot) {
      axis = JSON.parse(plot.dataset.x);
      const ay = JSON.parse(plot.dataset.y);
      cursor = document.createElementNS(plot.namespaceURI, 'line');
      cursor.setAttribute('class', 'cursor');
      cursor.setAttribute('y1', ay[0]);
      cursor.setAttribute('y2', ay[1]);
      plot.appendChild(cursor);
    }
    const designs = data.designs.map(function (m, i) {
      const of = function (name) {
        return Array.from(svg.querySelectorAll('.' + name + '[data-d="' + i + '"]'));
      };
      return {m: m, carrier: of('carrier'), rack: of('rack'), rods: of('rod'), springs: of('spring'), dial: of('dial'), force: of('force')};
    });
    slider.max = frames - 1;
    function draw() {
      const k = +slider.value, g = +gain.value;
      // The names stand where the points rest.
      svg.querySelector('.names').style.opacity = k > 0 ? 0.15 : 1;
      designs.forEach(function (d) {
        const m = d.m, s = data.scale * g;
        const dx = -m.y[k] * s, dy = -m.x[k] * s, psi = m.psi[k] * g, rack = -m.rack[k] * s;
        const turn = -psi * 180 / Math.PI, cx = m.centre[0], cy = m.centre[1];
        const move = function (x, y) {
          const c = Math.cos(psi), n = Math.sin(psi), u = x - cx, v = y - cy;
          return [cx + dx + c * u + n * v, cy + dy - n * u + c * v];
        };
        d.carrier.forEach(function (e) {
          e.setAttribute('transform', 'translate(' + dx.toFixed(2) + ',' + dy.toFixed(2) + ')rotate(' +
            turn.toFixed(3) + ',' + cx + ',' + cy + ')');
        });
        d.rack.forEach(function (e) { e.setAttribute('transform', 'translate(' + rack.toFixed(2) + ',0)'); });
        d.rods.forEach(function (e) {
          const p = move(+e.dataset.ox, +e.dataset.oy);
          e.setAttribute('x1', p[0].toFixed(1));
          e.setAttribute('y1', p[1].toFixed(1));
          e.setAttribute('x2', (+e.dataset.ix + rack).toFixed(1));
        });
        d.springs.forEach(function (e) {
          const p = move(+e.dataset.ax, +e.dataset.ay);
          e.setAttribute('d', springPath(p[0], p[1], +e.dataset.gx, +e.dataset.gy));
        });
        d.dial.forEach(function (e) {
          e.setAttribute('transform', 'rotate(' + (-m.wheel[k] * g * 180 / Math.PI).toFixed(2) + ',' + e.dataset.cx + ',' + e.dataset.cy + ')');
        });
      });
      if (cursor) {
        const px = toPixel(axis, data.t[k]);
        cursor.setAttribute('x1', px);
        cursor.setAttribute('x2', px);
      }
      out.textContent = 't = ' + data.t[k].toFixed(3) + ' s' +
        (data.force.length ? ', road force ' + Math.round(data.force[k]) + ' N' : '') + ', displacements × ' + g;
    }
    let running = false, last = 0, position = 0;
    function step(now) {
      if (!running) return;
      // One second of motion takes eight seconds.
      position += (now - last) / 1000 / 8 / (data.t[frames - 1] - data.t[0]) * frames;
      last = now;
      if (position >= frames) position = 0;
      slider.value = Math.floor(position);
      draw();
      requestAnimationFrame(step);
    }
    play.addEventListener('click', function () {
      running = !running;
      play.textContent = running ? 'Pause' : 'Play';
      last = performance.now();
      position = +slider.value;
      if (running) requestAnimationFrame(step);
    });
    slider.addEventListener('input', draw);
    gain.addEventListener('input', draw);
    window.addEventListener('beforeprint', function () { running = false; play.textContent = 'Play'; slider.value = 0; draw(); });
    draw();
  }
  document.querySelectorAll('.geo.moving').forEach(animate);

  window.addEventListener('beforeprint', function () {
    document.querySelectorAll('details').forEach(function (d) { d.open = true; });
  });

  // Where the reader is, in the table of contents.
  const links = new Map();
  document.querySelectorAll('nav a').forEach(function (a) { links.set(a.getAttribute('href').slice(1), a); });
  if ('IntersectionObserver' in window) {
    const observer = new IntersectionObserver(function (entries) {
      entries.forEach(function (e) {
        if (!e.isIntersecting || !links.has(e.target.id)) return;
        links.forEach(function (a) { a.classList.remove('here'); });
        links.get(e.target.id).classList.add('here');
      });
    }, {rootMargin: '0px 0px -75% 0px'});
    document.querySelectorAll('h2[id],h3[id]').forEach(function (h) { observer.observe(h); });
  }

  window.addEventListener('load', function () {
    root.setAttribute('data-resources', String(performance.getEntriesByType('resource').length));
    root.setAttribute('data-ready', '1');
  });
})();
)js";
}

}  // namespace kingpin::report
