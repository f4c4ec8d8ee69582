//! Samples that go onto the film and are watched on the way: what they bring tells plans apart.

use bidir_kernel::{ByJoin, Contribution, Rivals, Vec2};

use super::pilot::brought;
use crate::{
    film::Exposure,
    plan::evidence::{Grid, Record},
};

/// What is watched for, and where on the image.
#[derive(Clone, Debug)]
pub struct Watch {
    pub(super) record: Record,
    pub(super) grid: Grid,
}

impl Watch {
    /// The same, with nothing seen.
    pub(super) fn blank(&self) -> Self {
        Self { record: self.record.blank(), ..*self }
    }
}

/// A unit's buffer that is watched.
pub(super) struct Watched<'a, B> {
    buffer: &'a mut B,
    watch: &'a mut Watch,
    /// The cell of the camera path under way.
    cell: u32,
    /// How the next contribution was weighed.
    weighed: (f64, ByJoin),
}

impl<'a, B: Exposure> Watched<'a, B> {
    /// For one sample, whose camera path begins at `raster`.
    pub(super) fn new(buffer: &'a mut B, watch: &'a mut Watch, raster: Vec2) -> Self {
        let cell = watch.grid.at(raster).unwrap_or(0);
        Self { buffer, watch, cell, weighed: (1.0, ByJoin::NONE) }
    }
}

impl<B: Exposure> bidir_kernel::Film for Watched<'_, B> {
    type Rivals = ByJoin;

    fn weighed(&mut self, own: f64, others: ByJoin) {
        self.weighed = (own, others);
    }

    fn add(&mut self, contribution: Contribution) {
        if let Some(brought) = brought(&contribution, &self.weighed) {
            self.watch.record.take(self.cell, &brought);
        }
        self.buffer.add(contribution);
    }

    fn splat(&mut self, raster: Vec2, contribution: Contribution) {
        if let (Some(brought), Some(cell)) = (brought(&contribution, &self.weighed), self.watch.grid.at(raster)) {
            self.watch.record.take(cell, &brought);
        }
        self.buffer.splat(raster, contribution);
    }
}

#[cfg(test)]
mod tests {
    use std::{path::Path, sync::atomic::AtomicBool, time::Duration};

    use bidir_kernel::Techniques;

    use crate::{
        film::Film,
        image::Image,
        load::load_str,
        plan::{Stage, effects::Effects},
        plugin::{Library, Strictness},
        render::{Director, Job, Leg, Numbers, Status, Target, Told, Watch, directed, pilot::Pilot},
        scene::Scene,
    };

    /// A ball of glass in a lit box, before a lens that light lands on.
    const GLASS: &str = r#"<scene version="3.0.0">
        <sensor type="thinlens">
            <float name="aperture_radius" value="0.1"/><float name="focus_distance" value="4"/><float name="fov" value="50"/>
            <transform name="to_world"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
            <film type="hdrfilm"><integer name="width" value="20"/><integer name="height" value="20"/></film>
        </sensor>
        <shape type="rectangle"><transform name="to_world"><scale value="2"/><translate z="-1"/></transform></shape>
        <shape type="sphere"><float name="radius" value="0.6"/><bsdf type="dielectric"/></shape>
        <shape type="rectangle">
            <transform name="to_world"><rotate x="1" angle="90"/><translate y="2"/></transform>
            <emitter type="area"><rgb name="radiance" value="5"/></emitter>
        </shape></scene>"#;

    /// The same with nothing but what the smallest preset has.
    fn plain() -> String {
        let glass = r#"<shape type="sphere"><float name="radius" value="0.6"/><bsdf type="dielectric"/></shape>"#;
        GLASS
            .replace(glass, "")
            .replace("thinlens", "perspective")
            .replace(r#"<float name="aperture_radius" value="0.1"/><float name="focus_distance" value="4"/>"#, "")
    }

    /// One stage, watched or not.
    struct Fixed {
        stage: Stage,
        watch: Option<Watch>,
        seen: usize,
    }

    impl Director for Fixed {
        fn next(&mut self, _: &Scene, job: &Job, _: &Status, _: &dyn Told) -> Leg {
            let strategy = bidir_kernel::Strategy { techniques: self.stage.techniques(), ..job.strategy };
            Leg { strategy, weight: 1.0, end: u32::MAX, watch: self.watch.as_ref().map(Watch::blank) }
        }

        fn watched(&mut self, watch: Watch) {
            self.seen += watch.record.samples();
        }
    }

    #[test]
    fn samples_that_are_watched_are_the_same_bit_for_bit() {
        for content in [GLASS, &plain()] {
            let description = load_str(content, Path::new("s.xml"), None, &[], &Library::default()).unwrap().description;
            let scene = Scene::new(&description).unwrap();
            let few = Techniques { connection: 0.25, lens_splat: 0.5, lens_hit: 0.5, ..Techniques::BIDIRECTIONAL };
            for (techniques, numbers) in [(Techniques::BIDIRECTIONAL, Numbers::Sobol), (few, Numbers::Sobol), (few, Numbers::Independent)] {
                let stage = Stage::of(&techniques);
                let strategy = stage.strategy(&description.integrator);
                let target = Target::Samples(6);
                let job = Job { strategy, seed: 4, numbers, threads: 2, target, width: 20, strictness: Strictness::Strict };
                let mut pilot = Pilot::new(&description.film, &Effects::of(&description, &scene), None);
                pilot.look(&scene, &job, Duration::MAX, 64);
                let image = |watch: Option<Watch>| -> (Image, usize) {
                    let film = Film::new(&description.film).unwrap();
                    let mut director = Fixed { stage, watch, seen: 0 };
                    directed(&scene, &film, &job, &mut director, &AtomicBool::new(false), |_| None);
                    (film.develop(), director.seen)
                };
                let (plain, watched) = (image(None), image(Some(pilot.watch(&stage, &[stage, Stage::of(&Techniques::PATH)]))));
                let bits = |image: &Image| image.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect::<Vec<_>>();
                assert!(bits(&plain.0) == bits(&watched.0), "{techniques:?} {numbers:?}");
                assert_eq!([plain.1, watched.1], [0, 6 * 400]);
            }
        }
    }
}
