//! Layers beside the picture.

use std::{path::Path, sync::atomic::AtomicBool};

use bidir_kernel::Technique;

use crate::{
    error::{Error, Result},
    film::{Film, Pyramid},
    image::{Image, write::Layer},
    plan::{effects::Effects, joins::exists},
    render::{Job, features},
    scene::{
        Scene,
        description::{Aov, Description, Quantity},
    },
};

/// The longest paths whose techniques get layers.
const LONGEST: u32 = 6;

/// The layers of a render.
pub(super) struct Aovs(Vec<Aov>);

/// Layers on their way into a file.
pub(super) struct Developed(Vec<(String, &'static [&'static str], Image)>);

impl Aovs {
    /// Those that the scene asks for, if the picture can hold them, and those of the command line.
    pub fn new(description: &Description, names: &[String], output: &Path) -> Result<Self> {
        let exr = output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr"));
        if !exr && !names.is_empty() {
            return Err(Error::in_file(
                output,
                "only an EXR holds more than one layer",
                "give -o a name that ends in .exr, or leave --aov out",
            ));
        }
        if !exr && !description.integrator.aovs.is_empty() {
            eprintln!("warning: {}: the scene's aovs are left out; only an EXR holds more than one layer", output.display());
        }
        let mut all = if exr { description.integrator.aovs.clone() } else { Vec::new() };
        for quantity in Quantity::ALL {
            let layer = quantity.layer();
            let asked = names.iter().any(|name| name == quantity.name() || name == "all");
            if !asked || all.iter().any(|known| known.of == quantity) {
                continue;
            }
            if let Some(known) = all.iter().find(|known| known.name == layer.name) {
                let thing = format!("the scene has a layer {} for {}, and --aov asks for {}", known.name, known.of.name(), quantity.name());
                return Err(Error::in_file(output, thing, "name the scene's layer otherwise, or leave --aov out"));
            }
            all.push(layer);
        }
        Ok(Self(all))
    }

    /// A film that keeps techniques apart, where a layer asks for them.
    pub fn pyramid(&self, description: &Description) -> Result<Option<Pyramid>> {
        let longest = LONGEST.min(description.integrator.max_depth.unwrap_or(LONGEST)).max(1);
        let asked = self.0.iter().any(|aov| aov.of == Quantity::Techniques);
        asked.then(|| Pyramid::new(&description.film, longest)).transpose()
    }

    /// Everything that was asked for, of a render of so many samples per pixel.
    #[expect(clippy::too_many_arguments, reason = "layers are about everything there is")]
    pub fn develop(
        &self,
        description: &Description,
        scene: &Scene,
        job: &Job,
        film: &Film,
        pyramid: Option<&Pyramid>,
        samples: u32,
        interrupt: &AtomicBool,
    ) -> Result<Developed> {
        let first: Vec<Quantity> = self.0.iter().map(|aov| aov.of).filter(|quantity| quantity.is_of_first_surface()).collect();
        let mut found = features(scene, &description.film, job, &first, samples, interrupt)?.into_iter();
        let mut layers = Vec::new();
        for aov in &self.0 {
            let mut push = |name: String, image| layers.push((name, aov.channels(), image));
            match aov.of {
                Quantity::Techniques => {
                    let Some(pyramid) = pyramid else { continue };
                    let effects = Effects::of(description, scene);
                    for technique in pyramid.techniques().filter(|&technique| exists(&effects, technique)) {
                        let Technique { s, t } = technique;
                        let [weighted, _] = pyramid.develop(technique);
                        push(format!("{}.s{s}t{t}", aov.name), weighted);
                    }
                }
                Quantity::Variance => push(aov.name.clone(), film.variance()),
                Quantity::Samples => {
                    let mut image = Image::black(description.film.crop.width, description.film.crop.height);
                    image.pixels.fill([samples as f32; 3]);
                    push(aov.name.clone(), image);
                }
                _ => found.next().into_iter().for_each(|image| push(aov.name.clone(), image)),
            }
        }
        Ok(Developed(layers))
    }
}

impl Developed {
    /// As they are written.
    pub fn layers(&self) -> Vec<Layer<'_>> {
        self.0.iter().map(|(name, channels, image)| Layer { name: name.clone(), channels, image }).collect()
    }
}
