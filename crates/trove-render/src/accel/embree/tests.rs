//! Embree where it fails; without it on this machine these are skipped.

use std::cell::Cell;
use std::ffi::{c_char, c_int, c_void};

use super::api::Handle;
use super::device::{Geometry, check};
use super::*;

unsafe extern "C" fn no_device(_: *const c_char) -> Handle {
    ptr::null_mut()
}

unsafe extern "C" fn no_scene(_: Handle) -> Handle {
    ptr::null_mut()
}

unsafe extern "C" fn no_geometry(_: Handle, _: c_int) -> Handle {
    ptr::null_mut()
}

unsafe extern "C" fn no_buffer(_: Handle, _: c_int, _: u32, _: c_int, _: usize, _: usize) -> *mut c_void {
    ptr::null_mut()
}

thread_local! {
    static NEW_SCENE: Cell<Option<unsafe extern "C" fn(Handle) -> Handle>> = const { Cell::new(None) };
}

/// Embree's own function while there is one.
unsafe extern "C" fn a_scene_while_there_are_any(device: Handle) -> Handle {
    // SAFETY: as for `rtcNewScene`.
    NEW_SCENE.get().map_or(ptr::null_mut(), |new_scene| unsafe { new_scene(device) })
}

/// Embree in `TROVE_EMBREE`, which `make test` sets.
fn api() -> Api {
    Api::load(&[PathBuf::from(std::env::var_os("TROVE_EMBREE").expect("TROVE_EMBREE"))]).unwrap()
}

/// After its start, with another function.
fn broken(change: impl FnOnce(&mut Api)) -> Embree {
    let mut kernel = Embree::with(api()).unwrap();
    kernel.built = Default::default();
    change(&mut Arc::get_mut(&mut kernel.device).unwrap().api);
    kernel
}

/// A triangle that lies in World.
fn shapes() -> Arc<Shapes> {
    let mesh = Mesh {
        positions: vec![Vec3::Z, Vec3::X + Vec3::Z, Vec3::Y + Vec3::Z],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let way = Motion { middle: DAffine3::IDENTITY, ends: None };
    let placed = vec![Placed::new(InstanceId(1), Arc::new(mesh), 0.0, vec![0], &way, [true; 2], Sort::Solid)];
    Arc::new(Shapes::new(placed, [Opacity::default()].into()))
}

#[test]
#[ignore = "needs TROVE_EMBREE"]
fn null_for_an_answer_is_an_error_that_says_what_to_do() {
    let mut api = api();
    api.new_device = no_device;
    let problem = Embree::with(api).err().unwrap();
    assert!(problem.contains("no device"), "{problem}");
    for (doing, change) in [
        ("making a scene", (|api| api.new_scene = no_scene) as fn(&mut Api)),
        ("making a geometry", |api| api.new_geometry = no_geometry),
        ("making a buffer of 36 bytes", |api| api.new_buffer = no_buffer),
    ] {
        let error = broken(change).build(&shapes()).err().unwrap().to_string();
        assert!(error.contains(doing) && error.contains("free memory"), "{error}");
    }
}

#[test]
#[ignore = "needs TROVE_EMBREE"]
fn what_embree_says_of_an_error_is_told_once() {
    let kernel = broken(|_| ());
    let problem = Geometry::new(&kernel.device, 999).err().unwrap();
    assert!(problem.starts_with("making a geometry: ") && problem.contains("invalid geometry type"), "{problem}");
    // An error that comes without null, which nobody would see.
    let [top, bottom] = [(); 2].map(|()| BuiltScene::new(&kernel.device).unwrap());
    bottom.commit().unwrap();
    // Embree takes at most 129 time steps.
    top.attach_instance(&bottom, &[Affine3A::IDENTITY; 200], 0, u32::MAX).unwrap();
    let problem = top.commit().unwrap_err();
    assert!(problem.starts_with("building a scene: "), "{problem}");
    assert_eq!(check(&kernel.device.api, kernel.device.handle, "nothing"), Ok(()));
}

#[test]
#[ignore = "needs TROVE_EMBREE"]
fn an_object_is_found_alone_even_where_embree_has_run_out_of_memory() {
    let kernel = broken(|api| {
        NEW_SCENE.set(Some(api.new_scene));
        api.new_scene = a_scene_while_there_are_any;
    });
    let ray = Ray::new(Vec3::new(0.25, 0.5, 0.0), Vec3::Z);
    let [mut whole, mut short] = [[None]; 2];
    kernel.build(&shapes()).unwrap().closest_on(0, &[ray], &mut whole);
    let scene = kernel.build(&shapes()).unwrap();
    NEW_SCENE.set(None);
    scene.closest_on(0, &[ray], &mut short);
    for hit in [short[0].unwrap(), whole[0].unwrap()] {
        assert!((hit.t - 1.0).abs() < 1e-6 && (hit.instance, hit.triangle) == (0, 0), "{hit:?}");
    }
}
