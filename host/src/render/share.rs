//! What one thread does of a render: it claims units, samples their pixels, and commits them.

use std::{
    marker::PhantomData,
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

use bidir_kernel::{Sampler, Vec2, Walk, sample};

use super::{
    Job, Numbers,
    numbers::{Apart, Sobol, Source},
    storage,
    watch::{Watch, Watched},
};
use crate::{
    film::{Both, Exposure, Film, Pyramid, Store},
    image::Image,
    plugin::{Fault, Quarantine},
    scene::{
        Scene,
        preset::{Full, Preset, Task},
        view::{RayCounts, View},
    },
};

/// What a canvas tells of what is on it.
pub trait Told {
    /// Its own relMSE; `None` if it cannot tell, or cannot yet.
    fn error(&self) -> Option<f64> {
        None
    }

    /// The picture so far, if it is one.
    fn picture(&self) -> Option<Image> {
        None
    }
}

/// What can be rendered onto. Sampling is compiled here, once for each, and not again wherever something is rendered.
pub trait Canvas: Store + Told + Sized {
    /// One thread's share.
    fn share(share: Share<'_, Self>) -> Worked;
}

impl Told for Film {
    fn error(&self) -> Option<f64> {
        self.noise().map(|noise| noise.relmse)
    }

    fn picture(&self) -> Option<Image> {
        Some(self.develop())
    }
}

impl Told for Pyramid {}

impl Told for Both<'_> {
    fn error(&self) -> Option<f64> {
        self.film.error()
    }
}

impl Canvas for Film {
    fn share(share: Share<'_, Self>) -> Worked {
        match (share.job.numbers, share.watch) {
            (Numbers::Sobol, None) => share.with::<Sobol>(),
            (Numbers::Sobol, Some(watch)) => share.watched::<Sobol>(watch.blank()),
            (Numbers::Independent, None) => share.with::<Apart>(),
            (Numbers::Independent, Some(watch)) => share.watched::<Apart>(watch.blank()),
        }
    }
}

impl Canvas for Pyramid {
    /// With the preset for any scene: pyramids are looked at, and not waited for.
    fn share(share: Share<'_, Self>) -> Worked {
        match share.job.numbers {
            Numbers::Sobol => By::<_, Sobol>(share, PhantomData).run(Full {}),
            Numbers::Independent => By::<_, Apart>(share, PhantomData).run(Full {}),
        }
    }
}

impl Canvas for Both<'_> {
    /// As with a pyramid alone.
    fn share(share: Share<'_, Self>) -> Worked {
        match share.job.numbers {
            Numbers::Sobol => By::<_, Sobol>(share, PhantomData).run(Full {}),
            Numbers::Independent => By::<_, Apart>(share, PhantomData).run(Full {}),
        }
    }
}

/// Lets the other threads go if this one breaks down: what it had claimed never arrives.
struct Guard<'a, S: Store>(&'a S);

impl<S: Store> Drop for Guard<'_, S> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.abandon();
        }
    }
}

/// Why threads begin no other unit.
#[derive(Clone, Copy, Debug)]
pub struct Stop<'a> {
    pub(super) interrupt: Option<&'a AtomicBool>,
    /// Set by the thread whose plugin broke off.
    pub(super) faulted: &'a AtomicBool,
}

impl Stop<'_> {
    fn asked(&self) -> bool {
        self.faulted.load(Ordering::Relaxed) || self.interrupt.is_some_and(|interrupt| interrupt.load(Ordering::Relaxed))
    }
}

/// What one thread did.
#[derive(Debug)]
pub struct Worked {
    pub(super) begun: u32,
    pub(super) cpu: Duration,
    pub(super) rays: RayCounts,
    pub(super) quarantine: Quarantine,
    pub(super) fault: Option<Fault>,
    /// What its samples brought, where they were watched.
    pub(super) watch: Option<Watch>,
}

/// One thread's share of a render.
#[derive(Debug)]
pub struct Share<'a, S> {
    pub(super) scene: &'a Scene,
    pub(super) film: &'a S,
    pub(super) job: &'a Job,
    /// How much each sample counts.
    pub(super) weight: f64,
    pub(super) end: u32,
    pub(super) stop: Stop<'a>,
    /// What is watched for; not every canvas does.
    pub(super) watch: Option<&'a Watch>,
}

/// A share with its kind of numbers.
struct By<'a, S, N>(Share<'a, S>, PhantomData<N>);

impl<S: Store, N: Source> Task for By<'_, S, N> {
    type Output = Worked;

    fn run<P: Preset>(self, preset: P) -> Worked {
        let Share { scene, job, .. } = self.0;
        let view = View::with(scene, preset, job.strictness);
        let (mut camera_path, mut light_path) = (storage(&job.strategy), storage(&job.strategy));
        self.0.work::<N, _>(&view, |numbers: &mut N::OfPixel<'_>, raster, buffer: &mut S::Buffer| {
            sample(&view, &job.strategy, numbers, raster, &mut camera_path, &mut light_path, buffer);
        })
    }
}

/// A share that is watched.
struct Watching<'a, S, N>(Share<'a, S>, Watch, PhantomData<N>);

impl<S: Store, N: Source> Task for Watching<'_, S, N> {
    type Output = Worked;

    fn run<P: Preset>(self, preset: P) -> Worked {
        let Self(share, mut watch, _) = self;
        let Share { scene, job, .. } = share;
        let view = View::with(scene, preset, job.strictness);
        let (mut camera_path, mut light_path) = (storage(&job.strategy), storage(&job.strategy));
        let worked = share.work::<N, _>(&view, |numbers: &mut N::OfPixel<'_>, raster, buffer: &mut S::Buffer| {
            let mut film = Watched::new(buffer, &mut watch, raster);
            sample(&view, &job.strategy, numbers, raster, &mut camera_path, &mut light_path, &mut film);
            watch.record.end_sample();
        });
        Worked { watch: Some(watch), ..worked }
    }
}

impl<S: Store> Share<'_, S> {
    fn with<N: Source>(self) -> Worked {
        N::with_preset(self.scene, self.job.strategy.effects(), By::<_, N>(self, PhantomData))
    }

    /// Only plans with light walks are watched.
    fn watched<N: Source>(self, watch: Watch) -> Worked {
        N::with_light_walks(self.scene, self.job.strategy.effects(), Watching::<_, N>(self, watch, PhantomData))
    }

    /// Takes every sample by `sample`.
    #[inline(always)]
    fn work<N: Source, P: Preset>(&self, view: &View<P>, mut sample: impl FnMut(&mut N::OfPixel<'_>, Vec2, &mut S::Buffer)) -> Worked {
        let Self { film, job, weight, end, stop, .. } = *self;
        let _guard = Guard(film);
        let clock = cpu_time::ThreadTime::now();
        let mut begun = 0;
        while !stop.asked() {
            let Some(mut buffer) = film.claim(end) else { break };
            let unit = buffer.unit();
            buffer.weigh(weight);
            begun = begun.max(unit.sample + 1);
            let source = N::new(job.seed, unit.sample);
            view.sandbox().begin_tile(unit.index);
            for (x, y) in film.pixels(&unit) {
                let pixel = u64::from(y) * u64::from(job.width) + u64::from(x);
                let mut numbers = source.pixel(pixel);
                numbers.seek(Walk::Camera, 0);
                let [dx, dy] = numbers.next_pair();
                let raster = Vec2::new(x as f32 + dx, y as f32 + dy);
                buffer.begin(raster);
                sample(&mut numbers, raster, &mut buffer);
                if view.faulted() {
                    // Nothing of this tile is known to be whole. It is handed in empty, so that the tiles after it still arrive.
                    stop.faulted.store(true, Ordering::Relaxed);
                    buffer.clear();
                    break;
                }
                buffer.end();
            }
            film.commit(buffer);
        }
        let (quarantine, fault) = (view.sandbox().quarantine(), view.sandbox().fault());
        Worked { begun, cpu: clock.elapsed(), rays: view.rays(), quarantine, fault, watch: None }
    }
}

impl<S> Clone for Share<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for Share<'_, S> {}
