//! Embree 3 or 4 as a shared library, as far as triangles and single rays need it.

use std::ffi::{c_char, c_int, c_uint, c_void};

use bidir_kernel::{Ray, Vec3};
use libloading::Library;

type Handle = *mut c_void;

const ROBUST: c_int = 1 << 2;
const HIGH: c_int = 2;
const TRIANGLE: c_int = 0;
const INDEX: c_int = 0;
const VERTEX: c_int = 1;
const UINT3: c_int = 0x5003;
const FLOAT3: c_int = 0x9003;
const VERSION: c_int = 0;
const INVALID: u32 = u32::MAX;

/// Where Embree is looked for when nobody says.
const NAMES: [&str; 6] = ["libembree4.so.4", "libembree4.so", "libembree3.so.3", "libembree3.so", "libembree4.dylib", "embree4.dll"];

/// `RTCRayHit` of both versions; the end is room for what a build may have in addition.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct RayHit {
    origin: [f32; 3],
    near: f32,
    direction: [f32; 3],
    time: f32,
    far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    uv: [f32; 2],
    primitive: u32,
    geometry: u32,
    instance: [u32; 13],
}

/// `RTCIntersectContext` of Embree 3.
#[repr(C)]
struct Context {
    flags: c_int,
    filter: *const c_void,
    instance: [u32; 4],
}

type Intersect4 = unsafe extern "C" fn(Handle, *mut RayHit, *const c_void);
type Intersect3 = unsafe extern "C" fn(Handle, *mut Context, *mut RayHit);

#[derive(Clone, Copy)]
enum Calls {
    Four { intersect: Intersect4, occluded: Intersect4 },
    Three { intersect: Intersect3, occluded: Intersect3 },
}

/// The library with one device, which builds with one thread.
pub struct Embree {
    library: Library,
    device: Handle,
    calls: Calls,
    /// Major, minor, patch.
    pub version: [u32; 3],
}

/// A built scene.
pub struct Scene<'e> {
    embree: &'e Embree,
    handle: Handle,
}

impl Embree {
    /// Loads the library of that name, or one of the usual ones.
    pub fn load(name: Option<&str>) -> Result<Self, String> {
        let names: Vec<&str> = name.map_or_else(|| NAMES.to_vec(), |name| vec![name]);
        // SAFETY: Embree's initialisers do nothing but initialise Embree.
        let library = names.iter().find_map(|name| unsafe { Library::new(*name) }.ok());
        let library = library.ok_or_else(|| format!("no Embree at {}", names.join(", ")))?;
        // SAFETY: signatures as in `rtcore_device.h`.
        let (device, version) = unsafe {
            let device = call::<unsafe extern "C" fn(*const c_char) -> Handle>(&library, "rtcNewDevice")?(c"threads=1".as_ptr());
            let property = call::<unsafe extern "C" fn(Handle, c_int) -> isize>(&library, "rtcGetDeviceProperty")?;
            (device, property(device, VERSION) as u32)
        };
        let version = [version / 10_000, version / 100 % 100, version % 100];
        // SAFETY: signatures as in `rtcore_scene.h` of that version.
        let calls = unsafe {
            match version[0] {
                4 => Calls::Four { intersect: call(&library, "rtcIntersect1")?, occluded: call(&library, "rtcOccluded1")? },
                3 => Calls::Three { intersect: call(&library, "rtcIntersect1")?, occluded: call(&library, "rtcOccluded1")? },
                other => return Err(format!("Embree {other} is not known here")),
            }
        };
        Ok(Self { library, device, calls, version })
    }

    /// Builds with the best quality; robust intersections or the default ones.
    pub fn scene(&self, vertices: &[Vec3], triangles: &[[u32; 3]], robust: bool) -> Result<Scene<'_>, String> {
        // SAFETY: signatures as in `rtcore_scene.h` and `rtcore_geometry.h`; the buffers have room for what is written.
        unsafe {
            let library = &self.library;
            let scene = call::<unsafe extern "C" fn(Handle) -> Handle>(library, "rtcNewScene")?(self.device);
            call::<unsafe extern "C" fn(Handle, c_int)>(library, "rtcSetSceneBuildQuality")?(scene, HIGH);
            call::<unsafe extern "C" fn(Handle, c_int)>(library, "rtcSetSceneFlags")?(scene, if robust { ROBUST } else { 0 });
            let geometry = call::<unsafe extern "C" fn(Handle, c_int) -> Handle>(library, "rtcNewGeometry")?(self.device, TRIANGLE);
            type NewBuffer = unsafe extern "C" fn(Handle, c_int, c_uint, c_int, usize, usize) -> *mut c_void;
            let buffer = call::<NewBuffer>(library, "rtcSetNewGeometryBuffer")?;
            let places = buffer(geometry, VERTEX, 0, FLOAT3, 12, vertices.len()).cast::<f32>();
            for (i, number) in vertices.iter().flat_map(|v| v.to_array()).enumerate() {
                places.add(i).write(number);
            }
            let places = buffer(geometry, INDEX, 0, UINT3, 12, triangles.len()).cast::<u32>();
            for (i, index) in triangles.iter().flatten().enumerate() {
                places.add(i).write(*index);
            }
            call::<unsafe extern "C" fn(Handle)>(library, "rtcCommitGeometry")?(geometry);
            call::<unsafe extern "C" fn(Handle, Handle) -> c_uint>(library, "rtcAttachGeometry")?(scene, geometry);
            call::<unsafe extern "C" fn(Handle)>(library, "rtcReleaseGeometry")?(geometry);
            Ok(Scene { embree: self, handle: scene })
        }
    }
}

/// # Safety
/// The function has that type.
unsafe fn call<F: Copy>(library: &Library, name: &str) -> Result<F, String> {
    // SAFETY: the caller's promise.
    unsafe { library.get::<F>(name.as_bytes()) }.map(|function| *function).map_err(|error| error.to_string())
}

impl Scene<'_> {
    /// Builds the tree.
    pub fn build(&self) -> Result<(), String> {
        // SAFETY: as in `rtcore_scene.h`.
        unsafe { call::<unsafe extern "C" fn(Handle)>(&self.embree.library, "rtcCommitScene")?(self.handle) };
        Ok(())
    }

    /// The first triangle on the ray and its distance.
    #[inline]
    pub fn closest(&self, ray: &Ray) -> Option<(u32, f32)> {
        let mut query = query(ray);
        // SAFETY: the scene is built and alive; the query has the layout of `RTCRayHit`.
        unsafe {
            match self.embree.calls {
                Calls::Four { intersect, .. } => intersect(self.handle, &mut query, std::ptr::null()),
                Calls::Three { intersect, .. } => intersect(self.handle, &mut context(), &mut query),
            }
        }
        (query.geometry != INVALID).then_some((query.primitive, query.far))
    }

    /// Whether anything is on the ray.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        let mut query = query(ray);
        // SAFETY: as above; a ray is the beginning of a query.
        unsafe {
            match self.embree.calls {
                Calls::Four { occluded, .. } => occluded(self.handle, &mut query, std::ptr::null()),
                Calls::Three { occluded, .. } => occluded(self.handle, &mut context(), &mut query),
            }
        }
        query.far < 0.0
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        // SAFETY: as in `rtcore_scene.h`; nobody has the handle any more.
        unsafe {
            if let Ok(release) = call::<unsafe extern "C" fn(Handle)>(&self.embree.library, "rtcReleaseScene") {
                release(self.handle);
            }
        }
    }
}

#[inline(always)]
fn query(ray: &Ray) -> RayHit {
    RayHit {
        origin: ray.origin.to_array(),
        near: 0.0,
        direction: ray.direction.to_array(),
        time: 0.0,
        far: ray.t_max,
        mask: u32::MAX,
        id: 0,
        flags: 0,
        normal: [0.0; 3],
        uv: [0.0; 2],
        primitive: INVALID,
        geometry: INVALID,
        instance: [INVALID; 13],
    }
}

#[inline(always)]
fn context() -> Context {
    Context { flags: 0, filter: std::ptr::null(), instance: [INVALID; 4] }
}
