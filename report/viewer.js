// SPDX-License-Identifier: Apache-2.0
// One viewer per scene: two images under a slider, all of them below, one zoom, exposure and mode for all. Images are
// RGBE: red, green, blue and a common exponent, a byte each.
'use strict';

function decodeImage(source) {
  const bytes = Uint8Array.from(atob(source.rgbe), c => c.charCodeAt(0));
  const count = source.width * source.height;
  const pixels = new Float32Array(3 * count);
  for (let p = 0; p < count; ++p) {
    const scale = bytes[4 * p + 3] ? Math.pow(2, bytes[4 * p + 3] - 136) : 0;
    for (let c = 0; c < 3; ++c) pixels[3 * p + c] = bytes[4 * p + c] * scale;
  }
  return {name: source.name, caption: source.caption, width: source.width, height: source.height, pixels};
}

// Green's cubehelix (2011), as treefarm compare uses it: linear colours, brighter with every step.
function cubehelix(t) {
  const angle = 2 * Math.PI * (0.5 / 3 + 1 - 1.5 * t), amplitude = 0.5 * t * (1 - t);
  const cos = Math.cos(angle), sin = Math.sin(angle);
  return [t + amplitude * (-0.14861 * cos + 1.78277 * sin), t + amplitude * (-0.29227 * cos - 0.90649 * sin),
          t + amplitude * 1.97294 * cos];
}

function toByte(linear) {
  const x = Math.min(1, Math.max(0, linear));
  return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * Math.pow(x, 1 / 2.4) - 0.055));
}

class Viewer {
  constructor(element, images) {
    this.element = element;
    this.images = images.map(decodeImage);
    this.reference = this.images[this.images.length - 1];
    this.zoom = 1; this.x = 0; this.y = 0; this.split = 0.5; this.stops = 0; this.errors = false;
    this.raster = this.images.map(image => new OffscreenCanvas(image.width, image.height));
    this.build();
    this.develop();
  }

  build() {
    const add = (parent, tag, properties = {}) => parent.appendChild(Object.assign(document.createElement(tag), properties));
    const controls = add(this.element, 'div', {className: 'controls'});
    const control = (text, tag, properties, change) => {
      const label = add(controls, 'label', {textContent: text + ' '});
      const input = add(label, tag, properties);
      input.addEventListener('input', () => change(input));
      return input;
    };
    const choice = (text, selected, change) => {
      const select = control(text, 'select', {}, change);
      this.images.forEach((image, k) => add(select, 'option', {value: k, textContent: image.name, selected: k === selected}));
      return select;
    };
    this.left = 0;
    this.right = this.images.length > 2 ? this.images.length - 2 : this.images.length - 1;
    choice('left', this.left, s => { this.left = +s.value; this.draw(); });
    choice('right', this.right, s => { this.right = +s.value; this.draw(); });
    control('slider', 'input', {type: 'range', className: 'split', min: 0, max: 1, step: 0.005, value: 0.5},
            i => { this.split = +i.value; this.draw(); });
    control('exposure', 'input', {type: 'range', className: 'exposure', min: -8, max: 8, step: 0.25, value: 0},
            i => { this.stops = +i.value; this.develop(); });
    if (this.images.some(image => image.name === 'reference'))
      control('error in false colour', 'input', {type: 'checkbox', className: 'errors'},
            i => { this.errors = i.checked; this.develop(); });
    add(controls, 'button', {textContent: 'whole image', className: 'reset'}).addEventListener('click', () => {
      this.zoom = 1; this.x = this.y = 0; this.draw();
    });
    const shape = this.reference.height / this.reference.width;
    const canvas = (parent, width) => {
      const made = add(parent, 'canvas', {width, height: Math.round(width * shape)});
      this.follow(made);
      return made;
    };
    this.element.addEventListener('keydown', event => this.press(event));
    this.big = canvas(add(this.element, 'div', {className: 'big'}), 720);
    this.big.tabIndex = 0;
    this.big.setAttribute('role', 'img');
    this.big.setAttribute('aria-label', 'Two images under a slider');
    const grid = add(this.element, 'div', {className: 'grid'});
    this.small = this.images.map(image => {
      const figure = add(grid, 'figure');
      const made = canvas(figure, 250);
      add(figure, 'figcaption', {textContent: image.name + ': ' + image.caption});
      return made;
    });
  }

  // Wheel zooms at the pointer, dragging moves; both act on all pictures.
  follow(canvas) {
    canvas.addEventListener('wheel', event => {
      event.preventDefault();
      const u = event.offsetX / canvas.clientWidth, v = event.offsetY / canvas.clientHeight;
      const next = Math.min(64, Math.max(1, this.zoom * Math.exp(-0.002 * event.deltaY)));
      this.x += u / this.zoom - u / next;
      this.y += v / this.zoom - v / next;
      this.zoom = next;
      this.draw();
    }, {passive: false});
    canvas.addEventListener('pointerdown', event => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener('pointermove', event => {
      if (!(event.buttons & 1)) return;
      this.x -= event.movementX / canvas.clientWidth / this.zoom;
      this.y -= event.movementY / canvas.clientHeight / this.zoom;
      this.draw();
    });
  }

  // The big picture's keys: what wheel and dragging do, and the slider's.
  press(event) {
    if (event.target !== this.big) return;
    const step = 0.1 / this.zoom, zoomBy = factor => {
      const next = Math.min(64, Math.max(1, this.zoom * factor));
      this.x += 0.5 / this.zoom - 0.5 / next;
      this.y += 0.5 / this.zoom - 0.5 / next;
      this.zoom = next;
    };
    const keys = {
      '+': () => zoomBy(1.25), '-': () => zoomBy(0.8), ArrowLeft: () => { this.x -= step; },
      ArrowRight: () => { this.x += step; }, ArrowUp: () => { this.y -= step; }, ArrowDown: () => { this.y += step; }};
    if (!(event.key in keys)) return;
    event.preventDefault();
    keys[event.key]();
    this.draw();
  }

  // Radiance, or its relative error against the reference, to the screen's bytes.
  develop() {
    const scale = Math.pow(2, this.stops), b = this.reference.pixels;
    this.images.forEach((image, k) => {
      const context = this.raster[k].getContext('2d');
      const data = context.createImageData(image.width, image.height), a = image.pixels;
      for (let p = 0; p < image.width * image.height; ++p) {
        let colour = [a[3 * p] * scale, a[3 * p + 1] * scale, a[3 * p + 2] * scale];
        if (this.errors) {
          let sum = 0;
          for (let c = 0; c < 3; ++c) sum += Math.abs(a[3 * p + c] - b[3 * p + c]) / (b[3 * p + c] + 0.01);
          colour = cubehelix(Math.min(1, scale * sum / 3));
        }
        for (let c = 0; c < 3; ++c) data.data[4 * p + c] = toByte(colour[c]);
        data.data[4 * p + 3] = 255;
      }
      context.putImageData(data, 0, 0);
    });
    this.draw();
  }

  draw() {
    const limit = 1 - 1 / this.zoom;
    this.x = Math.min(limit, Math.max(0, this.x));
    this.y = Math.min(limit, Math.max(0, this.y));
    this.small.forEach((canvas, k) => this.paint(canvas, k, 0, 1));
    this.paint(this.big, this.left, 0, this.split);
    this.paint(this.big, this.right, this.split, 1);
    const context = this.big.getContext('2d');
    context.fillStyle = '#fff';
    context.fillRect(this.split * this.big.width - 1, 0, 2, this.big.height);
    this.element.dataset.zoom = this.zoom.toFixed(3);
  }

  // The part of image k that lies between two shares of the canvas' width.
  paint(canvas, k, from, to) {
    const context = canvas.getContext('2d'), image = this.images[k];
    context.imageSmoothingEnabled = false;
    context.save();
    context.beginPath();
    context.rect(from * canvas.width, 0, (to - from) * canvas.width, canvas.height);
    context.clip();
    context.drawImage(this.raster[k], this.x * image.width, this.y * image.height, image.width / this.zoom,
                      image.height / this.zoom, 0, 0, canvas.width, canvas.height);
    context.restore();
  }
}

for (const element of document.querySelectorAll('.viewer'))
  element.viewer = new Viewer(element, JSON.parse(element.querySelector('script').textContent));
