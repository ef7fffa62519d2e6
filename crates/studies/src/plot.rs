//! Doubly logarithmic plots of a study: a panel for each scene, curves of means over seeds in bands of 95 % confidence.
//!
//! The picture is drawn once, as SVG; the PNG is that SVG rendered, with a font that comes along, so that it looks the same on
//! every machine.

use crate::Error;
use crate::fit::{Place, curve};
use crate::results::{Table, short};
use crate::spec::{PlotSpec, Series, Spec};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use resvg::{tiny_skia, usvg};
use std::ops::Range;
use std::sync::Arc;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

const FONT: &str = "Ubuntu, sans-serif";
/// Pixels of a panel when there are several, and when there is one.
const PANEL: (u32, u32) = (470, 350);
const LONE_PANEL: (u32, u32) = (760, 470);
const TITLE_HEIGHT: u32 = 44;
const LEGEND_LINE: u32 = 24;
/// Expected width of a letter of the legend.
const LETTER: f64 = 7.2;
/// Pixels of a PNG for one of the SVG.
const PNG_SCALE: f32 = 1.5;

/// Least quotient of the ends of an axis.
const LEAST_RANGE: f64 = 12.0;
/// Guides that end left of this share of the horizontal axis have room for their name beside them.
const ROOM: f64 = 0.85;

const INK: RGBColor = RGBColor(45, 45, 48);
const GRID: RGBColor = RGBColor(226, 226, 230);
const GUIDE: RGBColor = RGBColor(150, 150, 156);
/// Colours that people of any sight tell apart (after Okabe & Ito 2008).
const COLOURS: [RGBColor; 9] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(190, 90, 150),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(60, 60, 60),
    RGBColor(140, 86, 75),
    RGBColor(127, 127, 0),
];

/// A curve with its looks.
struct Curve<'a> {
    series: &'a Series,
    places: Vec<Place>,
}

/// The plot as SVG.
///
/// # Errors
/// [`Error::Plot`], which a picture in memory should not meet.
pub fn svg(spec: &Spec, plot: &PlotSpec, table: &Table) -> Result<String, Error> {
    let series: Vec<&Series> = spec.series.iter().filter(|series| plot.shows(&series.name)).collect();
    let curves = |scene: &str| -> Vec<Curve> {
        let all = series.iter().map(|&series| Curve { series, places: curve(table, plot, scene, &series.name) });
        all.filter(|curve| !curve.places.is_empty()).collect()
    };
    let panels = spec.scenes.iter().map(|scene| (scene.name.as_str(), curves(&scene.name)));
    let panels: Vec<(&str, Vec<Curve>)> = panels.filter(|(_, curves)| !curves.is_empty()).collect();
    let columns = if panels.len() == 3 { 3 } else { panels.len().min(2) };
    let rows = panels.len().div_ceil(columns.max(1));
    let (width, height) = if panels.len() > 1 { PANEL } else { LONE_PANEL };
    let width = width * columns.max(1) as u32;
    let is_drawn = |series: &&&Series| {
        panels.iter().any(|(_, curves)| curves.iter().any(|curve| curve.series.name == series.name))
    };
    let drawn: Vec<&Series> = series.iter().filter(is_drawn).copied().collect();
    let legend = Legend::new(&drawn, width);
    let head = TITLE_HEIGHT + legend.height();
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (width, head + height * rows as u32)).into_drawing_area();
        draw(&area, plot, &panels, (rows, columns), &legend, head)
            .map_err(|what| Error::Plot { file: plot.file.clone(), what })?;
    }
    Ok(svg)
}

/// The SVG as PNG.
///
/// # Errors
/// [`Error::Plot`].
pub fn png(file: &str, svg: &str) -> Result<Vec<u8>, Error> {
    let wrong = |what: String| Error::Plot { file: file.to_owned(), what };
    let mut options = usvg::Options::default();
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    let family = fonts.faces().next().and_then(|face| face.families.first().map(|(name, _)| name.clone()));
    fonts.set_sans_serif_family(family.unwrap_or_default());
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| wrong(error.to_string()))?;
    let size = tree.size();
    let (width, height) = ((size.width() * PNG_SCALE) as u32, (size.height() * PNG_SCALE) as u32);
    let mut pixels = tiny_skia::Pixmap::new(width, height).ok_or_else(|| wrong("it has no size".to_owned()))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(PNG_SCALE, PNG_SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| wrong(error.to_string()))
}

fn draw(
    area: &Area,
    plot: &PlotSpec,
    panels: &[(&str, Vec<Curve>)],
    (rows, columns): (usize, usize),
    legend: &Legend,
    head: u32,
) -> Result<(), String> {
    area.fill(&WHITE).map_err(|error| error.to_string())?;
    let (top, bottom) = area.split_vertically(head);
    write(&top, &plot.title, (16, 14), 20, HPos::Left)?;
    legend.draw(&top)?;
    for ((name, curves), area) in panels.iter().zip(bottom.split_evenly((rows.max(1), columns.max(1)))) {
        panel(&area, plot, name, curves)?;
    }
    area.present().map_err(|error| error.to_string())
}

fn write(area: &Area, text: &str, at: (i32, i32), size: i32, side: HPos) -> Result<(), String> {
    let style = (FONT, size).into_font().color(&INK).pos(Pos::new(side, VPos::Top));
    area.draw_text(text, &style, at).map_err(|error| error.to_string())
}

fn panel(area: &Area, plot: &PlotSpec, name: &str, curves: &[Curve]) -> Result<(), String> {
    let text = |error: DrawingAreaErrorKind<_>| error.to_string();
    let places = || curves.iter().flat_map(|curve| &curve.places);
    let x = range(places().map(|place| place.x), 1.15);
    let y = range(places().map(|place| place.y.mean), 1.4);
    let mut chart = ChartBuilder::on(area)
        .caption(name, (FONT, 16).into_font().color(&INK))
        .margin(12)
        .x_label_area_size(46)
        .y_label_area_size(62)
        .build_cartesian_2d(x.clone().log_scale(), y.clone().log_scale())
        .map_err(text)?;
    let tick = |range: &Range<f64>| {
        let wide = range.end / range.start > 200.0;
        move |value: &f64| if wide { power_of_ten(*value) } else { one_two_five(*value) }
    };
    let (x_tick, y_tick) = (tick(&x), tick(&y));
    let mut mesh = chart.configure_mesh();
    mesh.light_line_style(TRANSPARENT).bold_line_style(GRID).axis_style(GUIDE);
    mesh.label_style((FONT, 13).into_font().color(&INK)).axis_desc_style((FONT, 14).into_font().color(&INK));
    mesh.x_desc(plot.x_label.as_str()).y_desc(plot.y_label.as_str());
    mesh.x_label_formatter(&x_tick).y_label_formatter(&y_tick);
    mesh.draw().map_err(text)?;

    for &slope in &plot.guides {
        let start = places().filter(|place| place.x < x.start * 2.0).map(|place| place.y.mean).fold(0.0, f64::max);
        let on = |at: f64| (at, 0.8 * start * (at / x.start).powf(slope));
        let edge = if slope < 0.0 { y.start } else { y.end };
        let end = x.start * (edge / on(x.start).1).powf(1.0 / slope);
        let line = [on(x.start), on(end.min(x.end))];
        chart.draw_series(DashedLineSeries::new(line, 2, 4, GUIDE.stroke_width(1))).map_err(text)?;
        // Beside the end of a line that leaves at the bottom or top, before it where there is no room; else under, or over, the end.
        let leaves = line[1].0 < x.end;
        let room = (line[1].0 / x.start).ln() < ROOM * (x.end / x.start).ln();
        let over = leaves == (slope < 0.0);
        let beside = if leaves && room { HPos::Left } else { HPos::Right };
        let place = Pos::new(beside, if over { VPos::Bottom } else { VPos::Top });
        let style = (FONT, 12).into_font().color(&GUIDE).pos(place);
        let name = format!(" slope {} ", short(slope).replace('-', "−"));
        chart.draw_series([Text::new(name, line[1], style)]).map_err(text)?;
    }
    for curve in curves {
        let colour = COLOURS[curve.series.colour % COLOURS.len()];
        let known: Vec<&Place> = curve.places.iter().filter(|place| place.y.low.is_finite()).collect();
        let within = |value: f64| value.clamp(y.start, y.end);
        let band = known.iter().map(|place| (place.x, within(place.y.low)));
        let band: Vec<_> = band.chain(known.iter().rev().map(|place| (place.x, within(place.y.high)))).collect();
        if known.len() > 1 {
            chart.draw_series([Polygon::new(band, colour.mix(0.13))]).map_err(text)?;
        }
    }
    for curve in curves {
        let colour = COLOURS[curve.series.colour % COLOURS.len()];
        let line: Vec<(f64, f64)> = curve.places.iter().map(|place| (place.x, place.y.mean)).collect();
        if curve.series.dashed {
            chart.draw_series(DashedLineSeries::new(line.clone(), 6, 4, colour.stroke_width(2))).map_err(text)?;
        } else {
            chart.draw_series(LineSeries::new(line.clone(), colour.stroke_width(2))).map_err(text)?;
        }
        let inside = if curve.series.dashed { WHITE } else { colour };
        chart.draw_series(line.iter().map(|&at| Circle::new(at, 3, inside.filled()))).map_err(text)?;
        chart.draw_series(line.iter().map(|&at| Circle::new(at, 3, colour.stroke_width(1)))).map_err(text)?;
    }
    Ok(())
}

/// From the smallest to the largest value and a little more, but wide enough that some ticks lie in it.
fn range(values: impl Iterator<Item = f64> + Clone, more: f64) -> Range<f64> {
    let (low, high) =
        values.fold((f64::MAX, f64::MIN_POSITIVE), |(low, high), value| (low.min(value), high.max(value)));
    let (low, high) = (low.min(high) / more, high * more);
    let wider = (LEAST_RANGE / (high / low)).max(1.0).sqrt();
    low / wider..high * wider
}

/// A label for every power of ten.
fn power_of_ten(value: f64) -> String {
    let exponent = value.log10().round();
    if (value / 10f64.powf(exponent) - 1.0).abs() < 1e-6 { in_short(value, exponent as i32) } else { String::new() }
}

/// A label for every value that begins with 1, 2 or 5.
fn one_two_five(value: f64) -> String {
    let exponent = (value.log10() + 1e-9).floor();
    let leading = value / 10f64.powf(exponent);
    match [1.0, 2.0, 5.0].iter().position(|digit| (leading / digit - 1.0f64).abs() < 1e-6) {
        Some(0) => in_short(value, exponent as i32),
        Some(_) if exponent < 4.0 => short(value),
        _ => String::new(),
    }
}

/// `10⁴` for large powers of ten.
fn in_short(power: f64, exponent: i32) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |digit: char| RAISED[digit.to_digit(10).unwrap_or(0) as usize];
    match exponent {
        4.. => format!("10{}", exponent.to_string().chars().map(raised).collect::<String>()),
        -5..=3 => short(power),
        _ => format!("1e{exponent}").replace('-', "−"),
    }
}

/// Names of the series, in columns.
struct Legend<'a> {
    series: &'a [&'a Series],
    columns: usize,
    column_width: i32,
}

impl<'a> Legend<'a> {
    fn new(series: &'a [&'a Series], width: u32) -> Legend<'a> {
        let longest = series.iter().map(|series| series.name.chars().count()).max().unwrap_or(0);
        let column_width = (longest as f64 * LETTER) as i32 + 60;
        let columns = (((width as i32 - 24) / column_width).max(1) as usize).min(series.len().max(1));
        // As few columns as the number of lines allows, so that the last line is not short.
        let columns = series.len().div_ceil(series.len().div_ceil(columns).max(1)).max(1);
        Legend { series, columns, column_width }
    }

    fn height(&self) -> u32 {
        self.series.len().div_ceil(self.columns) as u32 * LEGEND_LINE + 6
    }

    fn draw(&self, area: &Area) -> Result<(), String> {
        let text = |error: DrawingAreaErrorKind<_>| error.to_string();
        let lines = self.series.len().div_ceil(self.columns);
        for (k, series) in self.series.iter().enumerate() {
            let (column, line) = ((k / lines) as i32, (k % lines) as i32);
            let (x, y) = (20 + column * self.column_width, TITLE_HEIGHT as i32 + line * LEGEND_LINE as i32 + 9);
            let colour = COLOURS[series.colour % COLOURS.len()];
            let dashes: &[(i32, i32)] = if series.dashed { &[(0, 7), (11, 18), (22, 28)] } else { &[(0, 28)] };
            for (from, to) in dashes {
                let dash = PathElement::new([(x + from, y), (x + to, y)], colour.stroke_width(2));
                area.draw(&dash).map_err(text)?;
            }
            let inside = if series.dashed { WHITE } else { colour };
            area.draw(&Circle::new((x + 14, y), 3, inside.filled())).map_err(text)?;
            area.draw(&Circle::new((x + 14, y), 3, colour.stroke_width(1))).map_err(text)?;
            write(area, &series.name, (x + 36, y - 8), 14, HPos::Left)?;
        }
        Ok(())
    }
}
