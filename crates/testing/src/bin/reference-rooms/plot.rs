//! Histograms of z with the standard normal over them, one panel a room.

use anyhow::{Result, anyhow};
use plotters::prelude::*;

/// One histogram.
pub struct Panel {
    pub title: &'static str,
    /// z of every point, on the coarse mesh, on the fine mesh, and on others that are not drawn.
    pub z: Vec<Vec<f64>>,
}

const SIZE: (u32, u32) = (960, 330);
/// Values farther out are counted in the last bins.
const REACH: f64 = 6.0;
const BIN: f64 = 0.4;
/// Highest density shown.
const TOP: f64 = 0.5;
const FINE: RGBColor = RGBColor(158, 197, 233);
const COARSE: RGBColor = RGBColor(200, 90, 30);
const NORMAL: RGBColor = RGBColor(40, 40, 40);

/// The picture, as SVG.
///
/// # Errors
/// None that a picture in memory could meet.
pub fn histograms(panels: &[Panel]) -> Result<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        draw(&area, panels).map_err(|error| anyhow!("the plot: {error}"))?;
    }
    Ok(svg)
}

fn draw<B: DrawingBackend>(area: &DrawingArea<B, plotters::coord::Shift>, panels: &[Panel]) -> Result<(), String> {
    let text = |error: DrawingAreaErrorKind<B::ErrorType>| error.to_string();
    area.fill(&WHITE).map_err(text)?;
    for (k, (panel, area)) in panels.iter().zip(area.split_evenly((1, panels.len()))).enumerate() {
        let mut chart = ChartBuilder::on(&area)
            .caption(panel.title, ("sans-serif", 17))
            .margin(10)
            .x_label_area_size(46)
            .y_label_area_size(if k == 0 { 52 } else { 30 })
            .build_cartesian_2d(-REACH..REACH, 0.0..TOP)
            .map_err(text)?;
        let mut mesh = chart.configure_mesh();
        mesh.disable_x_mesh().light_line_style(TRANSPARENT).bold_line_style(RGBColor(225, 225, 225));
        mesh.x_labels(7).y_labels(6).label_style(("sans-serif", 14)).axis_desc_style(("sans-serif", 15));
        mesh.x_desc("z").y_desc(if k == 0 { "points per unit of z" } else { "" });
        mesh.x_label_formatter(&|z| format!("{z:.0}")).y_label_formatter(&|y| format!("{y:.1}"));
        mesh.draw().map_err(text)?;

        let (coarse, fine) = (densities(&panel.z[0]), densities(&panel.z[1]));
        let bar = |&(z, density): &(f64, f64)| Rectangle::new([(z, 0.0), (z + BIN, density.min(TOP))], FINE.filled());
        let bars = chart.draw_series(fine.iter().map(bar)).map_err(text)?;
        bars.label("fine mesh").legend(|(x, y)| Rectangle::new([(x, y - 5), (x + 16, y + 5)], FINE.filled()));
        let steps = coarse.iter().flat_map(|&(z, density)| [(z, density), (z + BIN, density)]);
        let line = chart.draw_series(LineSeries::new(steps, COARSE.stroke_width(1))).map_err(text)?;
        line.label("coarse mesh").legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], COARSE.stroke_width(1)));
        let normal = |z: f64| (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
        let curve = (-60..=60).map(|k| f64::from(k) * REACH / 60.0).map(|z| (z, normal(z)));
        let line = chart.draw_series(LineSeries::new(curve, NORMAL.stroke_width(2))).map_err(text)?;
        line.label("normal").legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], NORMAL.stroke_width(2)));
        if k == 0 {
            let mut legend = chart.configure_series_labels();
            legend.position(SeriesLabelPosition::UpperRight).label_font(("sans-serif", 13));
            legend.draw().map_err(text)?;
        }
    }
    area.present().map_err(text)
}

/// Lower end of each bin, and the share of values in it per unit of z.
fn densities(z: &[f64]) -> Vec<(f64, f64)> {
    let bins = (2.0 * REACH / BIN).round() as usize;
    let mut counts = vec![0.0; bins];
    for z in z {
        counts[(((z + REACH) / BIN).max(0.0) as usize).min(bins - 1)] += 1.0;
    }
    let density = |(k, count): (usize, f64)| (k as f64 * BIN - REACH, count / (z.len() as f64 * BIN));
    counts.into_iter().enumerate().map(density).collect()
}
