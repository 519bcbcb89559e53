//! Tables and curves as SVG images.

use std::fmt::Write;

use crate::machine;
use crate::table::Table;

const FONT: &str = "font-family=\"sans-serif\" font-size=\"14\"";
/// Colors that can be told apart, by people who see few colors too.
const COLORS: [&str; 8] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00", "#56b4e9", "#8a6d00"];

/// An image around other things, on white.
fn image(width: f64, height: f64, inside: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" {FONT}>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{inside}</svg>\n"
    )
}

/// Words: `style` is further attributes.
fn text(x: f64, y: f64, style: &str, words: &str) -> String {
    let words = words.replace('&', "&amp;").replace('<', "&lt;");
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" {style}>{words}</text>\n")
}

fn line([x1, y1]: [f64; 2], [x2, y2]: [f64; 2], color: &str) -> String {
    format!("<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" stroke=\"{color}\" fill=\"none\"/>\n")
}

/// A table as an image.
pub(crate) fn table(table: &Table) -> String {
    const LINE: f64 = 22.0;
    const NAMES: f64 = 190.0;
    const COLUMN: f64 = 125.0;
    let width = NAMES + COLUMN * table.columns.len() as f64 + 20.0;
    let right = |column: usize| NAMES + COLUMN * (column + 1) as f64;
    let mut inside = text(12.0, 26.0, "font-weight=\"bold\"", &table.title);
    let mut y = 26.0 + LINE * 1.3;
    for (column, name) in table.columns.iter().enumerate() {
        inside += &text(right(column), y, "text-anchor=\"end\" font-weight=\"bold\"", name);
    }
    for (is_group, name, cells) in table.lines() {
        y += LINE;
        if is_group {
            inside += &line([12.0, y + 6.0 - LINE], [width - 12.0, y + 6.0 - LINE], "#bbb");
            inside += &text(12.0, y, "font-style=\"italic\"", name);
        } else {
            inside += &text(24.0, y, "", name);
        }
        for (column, cell) in cells.iter().enumerate() {
            inside += &text(right(column), y, "text-anchor=\"end\"", cell);
        }
    }
    y += 6.0;
    for note in &table.notes {
        y += LINE * 0.9;
        inside += &text(12.0, y, "font-size=\"12\" fill=\"#555\"", note);
    }
    image(width, y + 16.0, &inside)
}

/// A curve: its name and its points.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    pub(crate) name: String,
    /// Which of the colors it has.
    pub(crate) color: usize,
    pub(crate) points: Vec<[f64; 2]>,
}

/// An axis on which twice as much is always the same length farther.
struct Axis {
    /// 1, 2, 5, 10, 20, … from a number that is not more than the lowest to one that is not less than the highest.
    marks: Vec<f64>,
    start: f64,
    end: f64,
}

impl Axis {
    fn new(numbers: impl Iterator<Item = f64>, start: f64, end: f64) -> Self {
        let (lowest, highest) = numbers
            .filter(|number| *number > 0.0)
            .fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
        let mut marks: Vec<f64> = (-3..=9)
            .flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * libm::pow(10.0, f64::from(power))))
            .collect();
        let first = marks.iter().rposition(|&mark| mark <= lowest).unwrap_or(0);
        let last = marks.iter().position(|&mark| mark >= highest).unwrap_or(marks.len() - 1);
        // At least two, so that there is a length.
        let last = last.clamp((first + 1).min(marks.len() - 1), marks.len() - 1);
        marks = marks[first.min(last - 1)..=last].to_vec();
        Self { marks, start, end }
    }

    fn place(&self, number: f64) -> f64 {
        let [lowest, highest] = [self.marks[0], self.marks[self.marks.len() - 1]].map(libm::log10);
        let part = (libm::log10(number) - lowest) / (highest - lowest);
        self.start + part * (self.end - self.start)
    }
}

/// A number at an axis.
fn label(number: f64) -> String {
    match number {
        1e6.. => format!("{}M", number / 1e6),
        1e4.. => format!("{}k", number / 1e3),
        _ => format!("{number}"),
    }
}

/// Curves over two logarithmic axes. Twice as much of one thing for twice as much of the other is a slope of 1.
pub(crate) fn curves(title: &str, [x_name, y_name]: [&str; 2], curves: &[Curve]) -> String {
    const LEFT: f64 = 70.0;
    const RIGHT: f64 = 620.0;
    const TOP: f64 = 44.0;
    const BOTTOM: f64 = 400.0;
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let x_axis = Axis::new(points().map(|point| point[0]), LEFT, RIGHT);
    let y_axis = Axis::new(points().map(|point| point[1]), BOTTOM, TOP);
    let mut inside = text(LEFT, 26.0, "font-weight=\"bold\"", title);
    for &mark in &x_axis.marks {
        let x = x_axis.place(mark);
        inside += &line([x, TOP], [x, BOTTOM], "#ddd");
        inside += &text(x, BOTTOM + 20.0, "text-anchor=\"middle\"", &label(mark));
    }
    for &mark in &y_axis.marks {
        let y = y_axis.place(mark);
        inside += &line([LEFT, y], [RIGHT, y], "#ddd");
        inside += &text(LEFT - 8.0, y + 5.0, "text-anchor=\"end\"", &label(mark));
    }
    inside += &text((LEFT + RIGHT) / 2.0, BOTTOM + 42.0, "text-anchor=\"middle\"", x_name);
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {})\"", (TOP + BOTTOM) / 2.0);
    inside += &text(18.0, (TOP + BOTTOM) / 2.0, &turned, y_name);
    for (place, curve) in curves.iter().enumerate() {
        let color = COLORS[curve.color % COLORS.len()];
        let seen: Vec<[f64; 2]> =
            curve.points.iter().map(|&[x, y]| [x_axis.place(x), y_axis.place(y)]).collect();
        inside += &polyline(&seen, color);
        let y = TOP + 12.0 + 22.0 * place as f64;
        inside += &polyline(&[[RIGHT + 16.0, y - 5.0], [RIGHT + 40.0, y - 5.0]], color);
        inside += &text(RIGHT + 48.0, y, "", &curve.name);
    }
    inside += &text(LEFT, BOTTOM + 64.0, "font-size=\"12\" fill=\"#555\"", &machine::description());
    image(830.0, BOTTOM + 80.0, &inside)
}

/// Points, and lines between them.
fn polyline(points: &[[f64; 2]], color: &str) -> String {
    let mut way = String::new();
    let mut dots = String::new();
    for (place, [x, y]) in points.iter().enumerate() {
        let step = if place == 0 { 'M' } else { 'L' };
        // Writing to a string does not fail.
        let _ = write!(way, "{step}{x:.1} {y:.1}");
        let _ = writeln!(dots, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{color}\"/>");
    }
    format!("<path d=\"{way}\" stroke=\"{color}\" stroke-width=\"2\" fill=\"none\"/>\n{dots}")
}
