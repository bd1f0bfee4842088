for (const law of document.querySelectorAll('.law')) {
  const data = JSON.parse(law.querySelector('script').textContent), motions = data.motions;
  const video = law.querySelector('video'), canvas = law.querySelector('canvas'), c = canvas.getContext('2d');
  const span = key => { const all = motions.flatMap(m => m[key]), lo = Math.min(0, ...all), hi = Math.max(0, ...all), pad = (hi - lo || 1) * 0.08; return [lo - pad, hi + pad]; };
  const V = span('v'), A = span('a'), H = 300;
  let W = 0;
  const pv = v => 60 + (W - 80) * (v - V[0]) / (V[1] - V[0]), pa = a => H - 44 - (H - 74) * (a - A[0]) / (A[1] - A[0]);
  // Round values between the ends, `most` or fewer.
  function ticks(range, most) {
    const least = (range[1] - range[0]) / most, power = 10 ** Math.floor(Math.log10(least));
    const step = power * [1, 2, 5, 10].find(d => d * power >= least), values = [];
    for (let i = Math.ceil(range[0] / step); i * step <= range[1]; i++) values.push(i * step);
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    return values.map(value => [value, show(value, digits)]);
  }
  function text(words, x, y, align) { c.textAlign = align; c.fillText(words, x, y); }
  function line(x0, y0, x1, y1, ink) { c.strokeStyle = ink; c.lineWidth = 1; c.beginPath(); c.moveTo(x0, y0); c.lineTo(x1, y1); c.stroke(); }
  function path(m, end) {
    c.strokeStyle = m.color; c.beginPath();
    for (let i = 0; i <= end; i++) {
      const jump = i == 0 || (m.v[i] * m.v[i - 1] <= 0 && m.v[i - 1] != 0);
      if (jump) c.moveTo(pv(m.v[i]), pa(m.a[i])); else c.lineTo(pv(m.v[i]), pa(m.a[i]));
    }
    c.stroke();
  }
  function draw() {
    c.clearRect(0, 0, W, H);
    c.font = '14px system-ui, "DejaVu Sans", sans-serif'; c.fillStyle = '#333';
    for (const [v, words] of ticks(V, Math.max(3, Math.floor(W / 90)))) { line(pv(v), pa(A[0]), pv(v), pa(A[1]), '#ddd'); text(words, pv(v), H - 26, 'center'); }
    for (const [a, words] of ticks(A, 6)) { line(pv(V[0]), pa(a), pv(V[1]), pa(a), '#ddd'); text(words, pv(V[0]) - 6, pa(a) + 5, 'right'); }
    line(pv(V[0]), pa(0), pv(V[1]), pa(0), '#777'); line(pv(0), pa(A[0]), pv(0), pa(A[1]), '#777');
    text('v (m/s)', W - 20, H - 7, 'right'); text('a (m/s²)', 8, 18, 'left');
    text('t = ' + show(video.currentTime, 2) + ' s', W - 20, 18, 'right');
    for (const [v, stable] of data.equilibria) {
      c.fillStyle = stable ? '#000' : '#fff'; c.strokeStyle = '#000'; c.lineWidth = 1.5;
      c.beginPath(); c.arc(pv(v), pa(0), 5, 0, 7); c.fill(); c.stroke();
    }
    const now = m => Math.min(Math.round(video.currentTime * data.rate), m.v.length - 1);
    c.globalAlpha = 0.4; c.lineWidth = 1.2; for (const m of motions) path(m, m.v.length - 1);
    c.globalAlpha = 1; c.lineWidth = 3; for (const m of motions) path(m, now(m));
    for (const m of motions) {
      c.fillStyle = m.color; c.strokeStyle = '#fff'; c.lineWidth = 1.5;
      c.beginPath(); c.arc(pv(m.v[now(m)]), pa(m.a[now(m)]), 6.5, 0, 7); c.fill(); c.stroke();
    }
  }
  // As many pixels as the screen has, so that words keep their size on a telephone.
  function fit() {
    const ratio = window.devicePixelRatio || 1;
    W = canvas.clientWidth;
    canvas.width = Math.round(W * ratio); canvas.height = Math.round(H * ratio);
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    draw();
  }
  function step() { draw(); if (!video.paused) requestAnimationFrame(step); }
  video.onplay = step; video.onseeked = draw; video.ontimeupdate = draw;
  window.addEventListener('resize', fit);
  fit();
}
