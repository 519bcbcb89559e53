// The book's live figures: a picture of a chapter becomes a canvas on which the chapter itself draws.
//
// The chapters are compiled to WebAssembly (src/lib.rs). A figure sends lines such as `set tilt=60`, asks for the pixels,
// and shows what `describe` says around them. Nothing is drawn or computed here.
//
//   figure.live[data-chapter][data-variant][data-module]
//     a > img           the still picture: shown until the figure runs, without scripts, and in print
//     .stage            the canvas, a handle for each point, the loupe
//     .bar              mistake | remedy | difference, play, reset, rasterizer
//     .knobs            a slider, a list, a box for each knob; below, what to watch
//     details           the history of a pixel; the command that draws the same picture
// @ts-check
"use strict";

(() => {
    /**
     * What the module exports.
     * @typedef {{
     *   memory: WebAssembly.Memory,
     *   text(length: number): number, length(): number,
     *   open(): number, event(figure: number): number,
     *   draw(figure: number): number,
     *   describe(figure: number): number, history(figure: number, x: number, y: number): number,
     * }} Exports
     * @typedef {{
     *   name: string, kind: string, value: string, default: string, range: string, watch: string,
     *   low?: number, high?: number, step?: number, unit?: string, names?: string[],
     * }} Knob
     * @typedef {{
     *   variant: string, look: string, size: [number, number], scales: boolean, knobs: Knob[],
     *   remedy: string | null, view: string, frame: number, frames: number, rate: number | null,
     *   rasterizers: string[] | null, rasterizer: string, command: string,
     * }} Description
     */

    /** Longer than this, in milliseconds, a picture may not take while something moves: then it is drawn smaller, so that
     *  sixty can be shown in a second. */
    const PATIENCE = 12;
    /** So long after the last movement the picture is drawn in full. */
    const REST = 160;
    /** How many pixels the loupe shows in each direction from the middle, and how large. */
    const LOUPE = { reach: 5, scale: 13 };

    /** The module, fetched once for all figures of the page. @type {Map<string, Promise<Module>>} */
    const modules = new Map();

    /** Texts in and out of the module's memory. */
    class Module {
        /** @param {Exports} exports */
        constructor(exports) {
            this.exports = exports;
        }

        /** @param {string} url */
        static async load(url) {
            const bytes = await (await fetch(url)).arrayBuffer();
            const { instance } = await WebAssembly.instantiate(bytes, {});
            return new Module(/** @type {any} */ (instance.exports));
        }

        /** @param {string} text */
        write(text) {
            const bytes = new TextEncoder().encode(text);
            const place = this.exports.text(bytes.length);
            new Uint8Array(this.exports.memory.buffer, place, bytes.length).set(bytes);
        }

        /** @param {number} place */
        read(place) {
            return new TextDecoder().decode(new Uint8Array(this.exports.memory.buffer, place, this.exports.length()));
        }
    }

    /**
     * An element with attributes and children.
     * @template {keyof HTMLElementTagNameMap} T
     * @param {T} tag @param {Record<string, string>} attributes @param {(Node | string)[]} children
     * @returns {HTMLElementTagNameMap[T]}
     */
    function make(tag, attributes = {}, ...children) {
        const element = document.createElement(tag);
        for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
        element.append(...children);
        return element;
    }

    /** @param {string} label @param {string} title @param {() => void} action */
    function button(label, title, action) {
        const element = make("button", { type: "button", title }, label);
        element.addEventListener("click", action);
        return element;
    }

    class Figure {
        /** @param {HTMLElement} root @param {Module} module @param {number} id */
        constructor(root, module, id) {
            this.root = root;
            this.module = module;
            this.id = id;
            /** @type {Description} */
            this.state = this.describe();
            /** Of the picture as it is drawn now. */
            this.width = this.state.size[0];
            this.height = this.state.size[1];
            this.factor = 1;
            this.isDue = false;
            this.isMoving = false;
            this.isVisible = true;
            this.cursor = { x: this.width >> 1, y: this.height >> 1 };
            /** What is to be done when the state has changed. @type {(() => void)[]} */
            this.updates = [];
            this.canvas = make("canvas", { tabindex: "0", role: "img" });
            // As large as ever while it has fewer pixels.
            this.canvas.style.width = `${this.width}px`;
            this.canvas.style.aspectRatio = `${this.width} / ${this.height}`;
            const context = this.canvas.getContext("2d", { willReadFrequently: true });
            if (!context) throw new Error("no canvas");
            this.context = context;
            this.stage = make("div", { class: "stage" }, this.canvas);
            const side = `${(2 * LOUPE.reach + 1) * LOUPE.scale}`;
            this.glass = make("canvas", { width: side, height: side });
            this.told = make("output", { class: "told" });
            this.loupe = make("div", { class: "loupe" }, this.glass, this.told);
            this.loupe.hidden = true;
            this.history = make("pre", { tabindex: "0" }, "Click a pixel of the picture.");
            this.about = make("summary", {}, "What happened at a pixel");
            this.box = make("details", { class: "history" }, this.about, this.history);
            this.addPoints();
            this.stage.append(this.loupe);
            const rest = [this.bar(), this.knobs(), this.box, this.commandBox()];
            const running = make("div", { class: "running" }, this.stage, ...rest);
            // Arrow keys are ours here; elsewhere on the page they turn to the next one.
            running.addEventListener("keydown", (event) => event.stopPropagation());
            root.append(running);
            this.listen();
            this.render();
            root.classList.add("runs");
        }

        // ------------------------------------------------------------ the module

        /** @returns {Description} */
        describe() {
            return JSON.parse(this.module.read(this.module.exports.describe(this.id)));
        }

        /** Sends a line; draws again if that changed something. @param {string} line */
        send(line) {
            this.module.write(line);
            const answer = this.module.exports.event(this.id);
            if (answer === 1) this.draw();
            return answer;
        }

        /** Sends what is part of a movement, such as dragging. @param {string} line */
        move(line) {
            this.isMoving = true;
            clearTimeout(this.resting);
            this.resting = setTimeout(() => this.rest(), REST);
            return this.send(line);
        }

        /** The movement is over: the picture in full. */
        rest() {
            this.isMoving = false;
            clearTimeout(this.resting);
            this.draw();
        }

        /** Draws before the screen is shown next. */
        draw() {
            if (this.isDue) return;
            this.isDue = true;
            requestAnimationFrame(() => this.render());
        }

        render() {
            this.isDue = false;
            const wanted = this.isMoving ? this.factor : 1;
            const [width, height] = this.state.size.map((side) => Math.max(1, Math.round(side / wanted)));
            if (width !== this.width || height !== this.height) {
                this.module.write(`size ${width}x${height}`);
                this.module.exports.event(this.id);
                [this.width, this.height] = [width, height];
            }
            const begin = performance.now();
            const place = this.module.exports.draw(this.id);
            if (this.canvas.width !== width || this.canvas.height !== height) {
                [this.canvas.width, this.canvas.height] = [width, height];
            }
            const bytes = new Uint8ClampedArray(this.module.exports.memory.buffer, place, 4 * width * height);
            this.context.putImageData(new ImageData(bytes, width, height), 0, 0);
            this.took = performance.now() - begin;
            if (!this.isMoving) this.factor = 1;
            else if (this.state.scales && this.took > PATIENCE) this.factor = Math.min(4, this.factor * 2);
            this.update();
        }

        /** Shows what has changed around the picture. */
        update() {
            this.state = this.describe();
            const knobs = this.state.knobs.map((knob) => `${knob.name} ${knob.value}`).join(", ");
            const keys = "Arrow keys choose a pixel, Enter tells its history.";
            this.canvas.setAttribute("aria-label", `${this.state.look}. ${knobs}. ${keys}`);
            for (const update of this.updates) update();
            this.remember();
            this.play();
        }

        /** @param {string} name */
        knob(name) {
            const knob = this.state.knobs.find((knob) => knob.name === name);
            if (!knob) throw new Error(`no knob ${name}`);
            return knob;
        }

        // ------------------------------------------------------------ what moves by itself

        play() {
            if (this.state.rate && !this.ticking) {
                this.ticking = true;
                this.last = performance.now();
                requestAnimationFrame((now) => this.tick(now));
            }
        }

        /** @param {number} now */
        tick(now) {
            this.ticking = false;
            if (!this.state.rate) return;
            const step = 1000 / this.state.rate;
            // A quarter of a frame early is on time: the screen has frames of its own.
            if (this.isVisible && now - (this.last ?? now) > 0.75 * step) {
                this.last = now;
                this.move("tick");
            }
            this.ticking = true;
            requestAnimationFrame((now) => this.tick(now));
        }

        // ------------------------------------------------------------ the bar

        bar() {
            const bar = make("div", { class: "bar" });
            if (this.state.remedy) bar.append(this.views(this.state.remedy));
            if (this.state.frames > 1) bar.append(this.playButton("Play", () => this.send("run")), this.frames());
            const { rasterizers } = this.state;
            if (rasterizers) {
                const choose = (/** @type {string} */ name) => this.send(`rasterizer ${name}`);
                const list = this.list("rasterizer", rasterizers, () => this.state.rasterizer, choose);
                bar.append(make("label", {}, "rasterizer ", list));
            }
            bar.append(button("Reset", "knobs and frame as at first", () => {
                this.send("reset");
                this.send("show itself");
            }));
            return bar;
        }

        /** @param {string} remedy */
        views(remedy) {
            const views = [["itself", this.state.variant], ["remedy", remedy], ["difference", "difference"]];
            const group = make("span", { class: "views", role: "group", "aria-label": "what is shown" });
            for (const [view, name] of views) {
                const element = button(name, `show ${name}`, () => this.send(`show ${view}`));
                this.updates.push(() => element.setAttribute("aria-pressed", `${this.state.view === view}`));
                group.append(element);
            }
            return group;
        }

        /** @param {string} label @param {() => void} start */
        playButton(label, start) {
            const element = button(label, "run or stop", start);
            this.updates.push(() => (element.textContent = this.state.rate ? "Stop" : label));
            return element;
        }

        frames() {
            const last = `${this.state.frames - 1}`;
            const slider = make("input", { type: "range", min: "0", max: last, step: "1", "aria-label": "frame" });
            const value = make("output");
            slider.addEventListener("input", () => this.move(`frame ${slider.value}`));
            this.updates.push(() => {
                slider.value = `${this.state.frame}`;
                value.textContent = `frame ${this.state.frame}`;
            });
            return make("label", {}, slider, value);
        }

        /** @param {string} label @param {string[]} names @param {() => string} now @param {(name: string) => void} choose */
        list(label, names, now, choose) {
            const list = make("select", { "aria-label": label }, ...names.map((name) => make("option", {}, name)));
            list.addEventListener("change", () => choose(list.value));
            this.updates.push(() => (list.value = now()));
            return list;
        }

        // ------------------------------------------------------------ knobs

        knobs() {
            const watch = make("p", { class: "watch", "aria-live": "polite" });
            const box = make("div", { class: "knobs" });
            for (const knob of this.state.knobs) {
                const row = this.row(knob);
                const show = () => (watch.textContent = `${knob.name}: ${knob.watch}`);
                for (const kind of ["focusin", "pointerdown"]) row.addEventListener(kind, show);
                box.append(row);
            }
            const [first] = this.state.knobs;
            if (first) watch.textContent = `${first.name}: ${first.watch}`;
            return make("div", {}, box, watch);
        }

        /** @param {Knob} knob */
        row({ name, kind, low = 0, high = 1, step = 1, unit = "", names = [] }) {
            const value = make("output");
            const set = (/** @type {string} */ text) => this.move(`set ${name}=${text}`);
            this.updates.push(() => (value.textContent = `${this.knob(name).value}${unit === "°" ? "" : " "}${unit}`));
            const row = (/** @type {HTMLElement[]} */ ...parts) => make("div", { class: "knob" }, ...parts);
            const label = (/** @type {HTMLElement} */ input) => make("label", {}, make("span", {}, name), input, value);
            if (kind === "number" || kind === "whole") {
                const exact = kind === "whole" ? "1" : "any";
                const slider = make("input", { type: "range", min: `${low}`, max: `${high}`, step: exact });
                const digits = kind === "whole" ? 0 : Math.max(0, 1 - Math.floor(Math.log10(step)));
                slider.addEventListener("input", () => {
                    set(`${Math.min(high, Math.max(low, Number(Number(slider.value).toFixed(digits))))}`);
                });
                slider.addEventListener("change", () => this.rest());
                this.updates.push(() => {
                    if (Number(slider.value) !== Number(this.knob(name).value)) slider.value = this.knob(name).value;
                });
                const sweep = this.playButton("▶", () => {
                    if (!this.state.rate) this.send(`set ${name}=${this.knob(name).value}`);
                    this.send(this.state.rate ? "run" : "sweep");
                });
                sweep.setAttribute("aria-label", `let ${name} run through its range`);
                return row(label(slider), sweep);
            }
            if (kind === "choice") {
                // The list shows its value by itself.
                const list = this.list(name, names, () => this.knob(name).value, set);
                return row(make("label", {}, make("span", {}, name), list));
            }
            if (kind === "switch" || kind === "color") {
                const input = make("input", { type: kind === "switch" ? "checkbox" : "color" });
                const told = () => (kind === "switch" ? (input.checked ? "on" : "off") : input.value.slice(1));
                input.addEventListener("input", () => set(told()));
                this.updates.push(() => {
                    input.checked = this.knob(name).value === "on";
                    if (kind === "color") input.value = `#${this.knob(name).value}`;
                });
                return row(label(input));
            }
            // A point is dragged in the picture; its handle is there.
            return row(make("div", { class: "place" }, make("span", {}, name), value));
        }

        addPoints() {
            for (const { name, kind, watch } of this.state.knobs) {
                if (kind !== "point") continue;
                const handle = make("button", { type: "button", class: "point", title: `${name}: ${watch}` });
                const [width, height] = this.state.size;
                const now = () => this.knob(name).value.split(",").map(Number);
                const put = (/** @type {number} */ x, /** @type {number} */ y) => {
                    const inside = [[x, width - 1], [y, height - 1]];
                    const [column, row] = inside.map(([at, last]) => Math.min(last, Math.max(0, Math.round(at))));
                    this.move(`set ${name}=${column},${row}`);
                };
                this.updates.push(() => {
                    const [x, y] = now();
                    handle.style.left = `${(100 * (x + 0.5)) / width}%`;
                    handle.style.bottom = `${(100 * (y + 0.5)) / height}%`;
                    handle.setAttribute("aria-label", `point ${name} at ${x}, ${y}; arrow keys move it`);
                });
                /** How far the point is from where it was taken. @type {[number, number] | null} */
                let held = null;
                handle.addEventListener("pointerdown", (event) => {
                    const [x, y] = this.place(event);
                    const [column, row] = now();
                    held = [column - x, row - y];
                    handle.setPointerCapture(event.pointerId);
                });
                handle.addEventListener("pointermove", (event) => {
                    if (!held) return;
                    const [x, y] = this.place(event);
                    put(x + held[0], y + held[1]);
                });
                for (const kind of ["pointerup", "pointercancel"]) {
                    handle.addEventListener(kind, () => {
                        held = null;
                        this.rest();
                    });
                }
                handle.addEventListener("keydown", (event) => {
                    const [x, y] = this.arrow(event);
                    const [column, row] = now();
                    if (x || y) put(column + x, row + y);
                });
                this.stage.append(handle);
            }
        }

        // ------------------------------------------------------------ pixels

        /** Where a pointer is in the picture's own size, y up. @param {PointerEvent} event */
        place(event) {
            const box = this.canvas.getBoundingClientRect();
            const [width, height] = this.state.size;
            return [
                ((event.clientX - box.left) / box.width) * width - 0.5,
                (1 - (event.clientY - box.top) / box.height) * height - 0.5,
            ];
        }

        /** The pixel under a pointer, of the picture as it is drawn now. @param {PointerEvent} event */
        pixel(event) {
            const [x, y] = this.place(event);
            const [width, height] = this.state.size;
            const inside = [[x, width, this.width], [y, height, this.height]];
            const at = inside.map(([at, all, now]) => Math.min(now - 1, Math.max(0, Math.floor(((at + 0.5) * now) / all))));
            return { x: at[0], y: at[1] };
        }

        /** What an arrow key moves by; ten times as far with Shift. @param {KeyboardEvent} event */
        arrow(event) {
            const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] };
            const way = ways[/** @type {keyof typeof ways} */ (event.key)];
            if (!way) return [0, 0];
            event.preventDefault();
            return way.map((by) => by * (event.shiftKey ? 10 : 1));
        }

        listen() {
            const { canvas } = this;
            const orbits = this.state.knobs.some((knob) => knob.name === "azimuth");
            if (orbits) canvas.classList.add("orbits");
            /** Where the button went down. @type {{ x: number, y: number } | null} */
            let down = null;
            let isDragged = false;
            canvas.addEventListener("pointerdown", (event) => {
                [down, isDragged] = [this.pixel(event), false];
                canvas.setPointerCapture(event.pointerId);
                if (orbits) this.send(`press ${down.x},${down.y}`);
            });
            canvas.addEventListener("pointermove", (event) => {
                this.cursor = this.pixel(event);
                if (down && Math.hypot(this.cursor.x - down.x, this.cursor.y - down.y) > 3) isDragged = true;
                if (down && orbits && isDragged) {
                    this.hideLoupe();
                    this.move(`drag ${this.cursor.x},${this.cursor.y}`);
                } else this.showLoupe();
            });
            canvas.addEventListener("pointerup", () => {
                this.send("release");
                if (down && !isDragged) this.tell();
                down = null;
                this.rest();
            });
            canvas.addEventListener("pointercancel", () => {
                down = null;
                this.send("release");
            });
            canvas.addEventListener("pointerleave", () => this.hideLoupe());
            canvas.addEventListener("blur", () => this.hideLoupe());
            canvas.addEventListener("keydown", (event) => {
                if (event.key === "Enter") return this.tell();
                if (event.key === "Escape") return this.hideLoupe();
                const [x, y] = this.arrow(event);
                if (!x && !y) return;
                this.cursor.x = Math.min(this.width - 1, Math.max(0, this.cursor.x + x));
                this.cursor.y = Math.min(this.height - 1, Math.max(0, this.cursor.y + y));
                this.showLoupe();
            });
            const seen = new IntersectionObserver(([entry]) => (this.isVisible = entry.isIntersecting));
            seen.observe(this.root);
            this.updates.push(() => this.loupe.hidden || this.showLoupe());
        }

        hideLoupe() {
            this.loupe.hidden = true;
        }

        /** The pixels around the cursor, large, with a grid; its place and color. */
        showLoupe() {
            const glass = this.glass.getContext("2d");
            if (!glass) return;
            const { x, y } = this.cursor;
            const { reach, scale } = LOUPE;
            const row = this.height - 1 - y;
            const count = 2 * reach + 1;
            const side = count * scale;
            glass.imageSmoothingEnabled = false;
            glass.fillStyle = "#808080";
            glass.fillRect(0, 0, side, side);
            glass.drawImage(this.canvas, x - reach, row - reach, count, count, 0, 0, side, side);
            glass.fillStyle = "rgb(128 128 128 / 60%)";
            for (let line = 1; line < count; line += 1) {
                glass.fillRect(line * scale, 0, 1, side);
                glass.fillRect(0, line * scale, side, 1);
            }
            for (const [color, out] of /** @type {[string, number][]} */ ([["#000", 0], ["#fff", 1]])) {
                glass.strokeStyle = color;
                glass.strokeRect(reach * scale + 0.5 - out, reach * scale + 0.5 - out, scale + 2 * out, scale + 2 * out);
            }
            const [red, green, blue] = this.context.getImageData(x, row, 1, 1).data;
            const hex = [red, green, blue].map((channel) => channel.toString(16).padStart(2, "0")).join("");
            this.told.textContent = `(${x}, ${y}) #${hex}`;
            this.loupe.hidden = false;
            // Beside the pixel, on the side where there is more room.
            this.loupe.classList.toggle("left", x > this.width / 2);
            this.loupe.style.left = `${(100 * (x + 0.5)) / this.width}%`;
            this.loupe.style.top = `${(100 * Math.min(row, 0.7 * this.height)) / this.height}%`;
        }

        // ------------------------------------------------------------ words

        /** The history of the pixel at the cursor. */
        tell() {
            this.asked = { ...this.cursor };
            this.box.open = true;
            this.remember();
        }

        /** The history of the pixel that was asked for, as it is now. */
        remember() {
            if (!this.asked || !this.box.open || this.isMoving) return;
            const { x, y } = this.asked;
            const place = this.module.exports.history(this.id, x, y);
            this.history.textContent = this.module.read(place).trimEnd();
            this.about.textContent = `What happened at the pixel (${x}, ${y})`;
        }

        commandBox() {
            const code = make("code");
            this.updates.push(() => (code.textContent = this.state.command));
            const copy = button("Copy", "copy the command", () => navigator.clipboard?.writeText(this.state.command));
            return make("details", { class: "command" }, make("summary", {}, "Command line"), make("p", {}, code, copy));
        }
    }

    /** @param {HTMLElement} root */
    async function start(root) {
        const { chapter, variant, frame, module: url } = root.dataset;
        if (!url) return;
        try {
            const loading = modules.get(url) ?? Module.load(url);
            modules.set(url, loading);
            const module = await loading;
            module.write(`${chapter} ${variant}`);
            const id = module.exports.open();
            if (id < 0) throw new Error(`no figure ${chapter} ${variant}`);
            module.write(`frame ${frame}`);
            module.exports.event(id);
            new Figure(root, module, id);
        } catch (error) {
            // The still picture stays.
            root.classList.remove("runs");
            console.error(error);
        }
    }

    // The page for printing shows stills, and a page that is no server's cannot fetch.
    const isStill = location.pathname.endsWith("print.html") || location.protocol === "file:";
    if (isStill || !("WebAssembly" in window)) return;
    const near = new IntersectionObserver((entries) => {
        for (const entry of entries.filter((entry) => entry.isIntersecting)) {
            near.unobserve(entry.target);
            start(/** @type {HTMLElement} */ (entry.target));
        }
    }, { rootMargin: "300px" });
    // After the text: what is read first is there first.
    window.addEventListener("load", () => {
        for (const figure of document.querySelectorAll("figure.live")) near.observe(figure);
    });
})();
