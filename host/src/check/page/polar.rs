//! Polar plots: what goes where in one plane through the normal.

use super::markup::short;

/// The circle's radius, in units of the drawing.
const RADIUS: f64 = 100.0;

/// So many factors of 10 below the largest, a logarithmic plot has its centre; the second where the first would leave out most of it.
const DECADES: [f64; 2] = [4.0, 8.0];

/// Lobes whose peak is more than this many times their mean are drawn in logarithms.
const PEAKED: f64 = 10.0;

/// How values become radii and colours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    pub(super) most: f64,
    pub(super) logarithmic: bool,
    pub(super) decades: f64,
}

impl Scale {
    pub(super) fn of(values: impl Iterator<Item = f64>) -> Self {
        Self::weighed(values.map(|value| (value, 1.0)))
    }

    /// Of plots that share it, each angle weighed by how much of the circle is about it.
    pub(super) fn common<'a>(plots: impl Iterator<Item = &'a Polar>) -> Self {
        Self::weighed(plots.flat_map(|plot| {
            let widths = plot.values.windows(2).map(|pair| pair[1].0 - pair[0].0).chain([0.0]);
            plot.values.iter().zip(widths).flat_map(|((_, bands), width)| bands.map(|value| (value, width)))
        }))
    }

    fn weighed(values: impl Iterator<Item = (f64, f64)>) -> Self {
        let values: Vec<_> = values.filter(|(value, _)| *value > 0.0).collect();
        let most = values.iter().map(|(value, _)| *value).fold(0.0, f64::max);
        let sum: f64 = values.iter().map(|(value, width)| value * width).sum();
        let extent = |from: f64, to: f64| -> f64 {
            values.iter().filter(|(value, _)| (from..=to).contains(&(value / most))).map(|(_, width)| width).sum()
        };
        let (near, far) = DECADES.map(|decades| 10.0_f64.powf(-decades)).into();
        let decades = DECADES[usize::from(extent(far, near) > 0.4 * extent(0.0, 1.0))];
        Self { most, logarithmic: most * extent(0.0, 1.0) > PEAKED * sum, decades }
    }

    /// In 0 … 1.
    pub(super) fn place(&self, value: f64) -> f64 {
        if value.is_nan() || value <= 0.0 || self.most <= 0.0 {
            return 0.0;
        }
        let share = value / self.most;
        if self.logarithmic { (1.0 + share.log10() / self.decades).clamp(0.0, 1.0) } else { share.min(1.0) }
    }

    /// What the outermost ring means; a unit begins with its space.
    pub(super) fn words(&self, unit: &str) -> String {
        let most = short(self.most);
        if self.most <= 0.0 {
            "nothing smooth there to draw".to_owned()
        } else if self.logarithmic {
            let ring = if self.decades > DECADES[0] { "a hundredth" } else { "a tenth" };
            format!("outer ring {most}{unit}, each ring inwards {ring}")
        } else {
            format!("outer ring {most}{unit}, linear")
        }
    }
}

/// A lobe into one direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrow {
    /// In the plane: 0 is up, clockwise.
    pub(super) angle: f64,
    pub(super) chance: f64,
}

/// What is drawn.
#[derive(Clone, Debug, Default)]
pub(super) struct Polar {
    /// Values of the bands by angle, sorted; 0 is up, clockwise, in radians.
    pub(super) values: Vec<(f64, [f64; 3])>,
    pub(super) arrows: Vec<Arrow>,
    /// Where the walk came from.
    pub(super) from: Option<f64>,
    /// Whether there is a lower half.
    pub(super) below: bool,
    /// What the page says to those who cannot see it.
    pub(super) title: String,
}

fn at(angle: f64, radius: f64) -> (f64, f64) {
    (RADIUS * radius * angle.sin(), -RADIUS * radius * angle.cos())
}

impl Polar {
    pub(super) fn svg(&self, scale: &Scale) -> String {
        let height = if self.below { 240 } else { 136 };
        let mut out = format!("<svg viewBox=\"-124 -120 248 {height}\" role=\"img\"><title>{}</title>\n", self.title);
        out += &self.rings();
        for (band, class) in self.bands() {
            out += &self.lobe(band, class, scale);
        }
        if let Some(from) = self.from {
            let ((x, y), (hx, hy)) = (at(from, 1.0), at(from, 0.72));
            out += &format!("<line class=\"from\" x1=\"{x:.1}\" y1=\"{y:.1}\" x2=\"0\" y2=\"0\"/>\n");
            out += &head((hx, hy), from + std::f64::consts::PI, "from");
        }
        self.arrows.iter().for_each(|arrow| out += &drawn(arrow));
        out + "</svg>\n"
    }

    fn rings(&self) -> String {
        let mut out = String::new();
        for ring in 1..=4 {
            let r = RADIUS * f64::from(ring) / 4.0;
            out += &if self.below {
                format!("<circle class=\"ring\" r=\"{r}\"/>\n")
            } else {
                format!("<path class=\"ring\" d=\"M{} 0A{r} {r} 0 0 1 {r} 0\"/>\n", -r)
            };
        }
        for degrees in (-60..=60).step_by(30) {
            let (x, y) = at(f64::from(degrees).to_radians(), 1.0);
            let (ox, oy) = if self.below { (-x, -y) } else { (0.0, 0.0) };
            out += &format!("<line class=\"ring\" x1=\"{ox:.1}\" y1=\"{oy:.1}\" x2=\"{x:.1}\" y2=\"{y:.1}\"/>\n");
        }
        out + "<line class=\"surface\" x1=\"-112\" y1=\"0\" x2=\"112\" y2=\"0\"/>\n"
    }

    /// One curve where all bands are the same, as far as one sees.
    fn bands(&self) -> Vec<(usize, &'static str)> {
        let most = self.values.iter().flat_map(|(_, bands)| *bands).fold(0.0, f64::max);
        let grey = self.values.iter().all(|(_, [r, g, b])| (r - g).abs().max((g - b).abs()) <= 0.01 * most.min(8.0 * g.max(*r)));
        if grey { vec![(1, "grey")] } else { vec![(0, "red"), (1, "green"), (2, "blue")] }
    }

    fn lobe(&self, band: usize, class: &str, scale: &Scale) -> String {
        let mut path = String::new();
        let mut last: Option<(f64, f64)> = None;
        for (angle, bands) in &self.values {
            let (x, y) = at(*angle, scale.place(bands[band]));
            // Points closer than this tell nothing.
            if last.is_none_or(|(lx, ly)| (x - lx).hypot(y - ly) > 0.4) {
                path += &format!("{}{x:.1} {y:.1}", if last.is_none() { "M" } else { "L" });
                last = Some((x, y));
            }
        }
        if path.contains('L') { format!("<path class=\"lobe {class}\" d=\"{path}Z\"/>\n") } else { String::new() }
    }
}

fn head((x, y): (f64, f64), angle: f64, class: &str) -> String {
    let corner = |turn: f64, length: f64| (x + length * (angle + turn).sin(), y - length * (angle + turn).cos());
    let ((ax, ay), (bx, by), (cx, cy)) = (corner(0.0, 6.0), corner(2.5, 5.0), corner(-2.5, 5.0));
    format!("<path class=\"{class} head\" d=\"M{ax:.1} {ay:.1}L{bx:.1} {by:.1}L{cx:.1} {cy:.1}Z\"/>\n")
}

fn drawn(arrow: &Arrow) -> String {
    let length = 0.35 + 0.5 * arrow.chance.clamp(0.0, 1.0);
    // Beside the tip, towards the normal but for those along it.
    let aside = if arrow.angle.abs() > 0.6 { -16.0 * arrow.angle.signum() } else { 16.0 };
    let (x, y) = at(arrow.angle, length);
    let (tx, ty) = (x + aside * arrow.angle.cos(), y + aside * arrow.angle.sin());
    let words = match 100.0 * arrow.chance {
        percent if percent >= 9.95 => format!("{percent:.0} %"),
        percent => format!("{percent:.1} %"),
    };
    format!(
        "<line class=\"delta\" x1=\"0\" y1=\"0\" x2=\"{x:.1}\" y2=\"{y:.1}\"/>\n{}<text x=\"{tx:.1}\" y=\"{:.1}\">{words}</text>\n",
        head((x, y), arrow.angle, "delta"),
        ty + 3.5
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_lobe_is_drawn_as_it_is_and_a_narrow_one_in_logarithms() {
        let wide = Scale::of((0..90).map(|d| f64::from(d).to_radians().cos()));
        assert!(!wide.logarithmic && wide.place(0.5) == 0.5);
        let narrow = Scale::of((0..90).map(|d| if d == 45 { 1000.0 } else { 0.3 }));
        assert!(narrow.logarithmic && (narrow.place(10.0) - 0.5).abs() < 1e-12);
        assert_eq!([0.0, -1.0, f64::NAN].map(|v| narrow.place(v)), [0.0; 3]);
    }
}
