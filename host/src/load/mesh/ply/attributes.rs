//! Which properties of a PLY are attributes, and what Mitsuba calls them: colours, and what ends in `_x`, `_r`, `_0` or `_1` and what
//! follows on that.

/// Properties that have a meaning of their own.
const RESERVED: [&str; 17] = ["x", "y", "z", "nx", "ny", "nz", "u", "v", "s", "t", "r", "g", "b", "a", "texture_u", "texture_v", "alpha"];

/// The ways to count the parts of an attribute.
const ENDINGS: [&str; 4] = ["xyzw", "rgba", "0123", "1234"];

/// An attribute, and the numbers of its properties: one or three.
#[derive(Debug, PartialEq)]
pub(super) struct Group {
    pub(super) name: String,
    pub(super) at: Vec<usize>,
}

/// The attributes among properties of that name, lists left out as `None`; `kind` is `vertex_` or `face_`.
pub(super) fn groups(kind: &str, properties: &[Option<&str>]) -> Vec<Group> {
    let find = |name: &str| properties.iter().position(|property| *property == Some(name));
    let all = |names: [&str; 3]| names.into_iter().map(find).collect::<Option<Vec<_>>>();
    let colour = all(["r", "g", "b"]).or_else(|| all(["red", "green", "blue"]));
    let mut runs = Runs { kind, found: Vec::new(), open: None, seen: Vec::new() };
    for (at, name) in properties.iter().enumerate() {
        match name {
            Some(name) if RESERVED.contains(name) || colour.as_ref().is_some_and(|colour| colour.contains(&at)) => {}
            Some(name) => runs.next(at, name),
            None => runs.close(),
        }
    }
    runs.close();
    let colour = colour.map(|at| Group { name: format!("{kind}color"), at });
    colour.into_iter().chain(runs.found).collect()
}

/// Properties that stand side by side and count on.
struct Runs<'a> {
    kind: &'a str,
    found: Vec<Group>,
    /// What their names begin with, how they count, and their numbers.
    open: Option<(&'a str, usize, Vec<usize>)>,
    seen: Vec<&'a str>,
}

impl<'a> Runs<'a> {
    fn next(&mut self, at: usize, name: &'a str) {
        let Some((prefix, ending)) = name.rsplit_once('_').filter(|(_, ending)| ending.len() == 1) else { return self.close() };
        if self.open.as_ref().is_some_and(|(open, ..)| *open != prefix) {
            self.close();
        }
        match &mut self.open {
            Some((_, way, parts)) => match ENDINGS[*way].get(parts.len()..parts.len() + 1) {
                Some(next) if next == ending => parts.push(at),
                // What does not count on is none at all.
                _ => self.open = None,
            },
            None if self.seen.contains(&prefix) => {}
            None => {
                let way = ENDINGS.iter().position(|way| way.starts_with(ending));
                self.open = way.map(|way| (prefix, way, vec![at]));
                self.seen.push(prefix);
            }
        }
    }

    fn close(&mut self) {
        if let Some((prefix, way, at)) = self.open.take()
            && matches!(at.len(), 1 | 3)
        {
            let colour = if way == 1 { "_color" } else { "" };
            self.found.push(Group { name: format!("{}{prefix}{colour}", self.kind), at });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As Mitsuba 3.9.1 names them, found by loading such files with it.
    #[test]
    fn attributes_are_those_of_mitsuba() {
        for (properties, names) in [
            ("x y z r g b", "vertex_color"),
            ("x y z red green blue alpha", "vertex_color"),
            ("x y z u v b g r", "vertex_color"),
            ("x y z foo", ""),
            ("x y z foo_x foo_y foo_z", "vertex_foo"),
            ("x y z foo_0 foo_1 foo_2", "vertex_foo"),
            ("x y z vertex_foo_r vertex_foo_g vertex_foo_b", "vertex_vertex_foo_color"),
            ("x y z foo_r foo_b foo_g", ""),
            ("x y z foo_x foo_y", ""),
            ("x y z foo_x bar_x", "vertex_foo vertex_bar"),
            ("x y z foo_bar", ""),
            ("x y z foo_w", ""),
            ("foo_x x y z foo_y foo_z", "vertex_foo"),
        ] {
            let split: Vec<_> = properties.split(' ').map(Some).collect();
            let found: Vec<_> = groups("vertex_", &split).into_iter().map(|group| group.name).collect();
            assert_eq!(found.join(" "), names, "{properties}");
        }
        assert_eq!(groups("face_", &[None, Some("b"), Some("r"), Some("g")]), [Group { name: "face_color".into(), at: vec![2, 3, 1] }]);
    }
}
