use std::error::Error as _;

use exr::prelude::traits::*;

use std::fs;

use super::*;

type Tested = std::result::Result<(), Box<dyn std::error::Error>>;

fn picture(width: u32, height: u32, offset: f32) -> Image {
    let pixel = |i: u32| [i as f32 * 0.37 + offset, 1e-7 * i as f32, 1e6 - i as f32];
    Image { width, height, pixels: (0..width * height).map(pixel).collect() }
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn an_exr_holds_every_layer_to_the_bit() -> Tested {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("a.exr");
    let (main, albedo) = (picture(37, 21, 0.0), picture(37, 21, 5.5));
    let notes = vec![("spp".into(), "16".into()), ("seed".into(), "3".into())];
    write(&path, &Layers { image: &main, named: vec![Layer::rgb("albedo", &albedo)], notes })?;

    let read = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes().from_file(&path)?;
    let channels = &read.layer_data.channel_data.list;
    let names: Vec<_> = channels.iter().map(|c| c.name.to_string()).collect();
    assert_eq!(names, ["B", "G", "R", "albedo.B", "albedo.G", "albedo.R"]);
    for (i, channel) in channels.iter().enumerate() {
        let image = if i < 3 { &main } else { &albedo };
        let expected: Vec<_> = image.pixels.iter().map(|p| p[2 - i % 3]).collect();
        assert_eq!(channel.sample_data.values_as_f32().collect::<Vec<_>>(), expected);
        assert!(matches!(channel.sample_data, ex::FlatSamples::F32(_)));
    }
    assert_eq!(read.layer_data.attributes.comments.map(|t| t.to_string()).as_deref(), Some("spp=16 seed=3"));
    assert_eq!(files(folder.path()), ["a.exr"]);
    Ok(())
}

#[test]
fn an_exr_of_the_same_picture_is_the_same_file() -> Tested {
    let folder = tempfile::tempdir()?;
    let image = picture(40, 40, 0.0);
    let notes: Vec<_> = (0..5).map(|i| (format!("note{i}"), "1".to_owned())).collect();
    for name in ["a.exr", "b.exr"] {
        write(&folder.path().join(name), &Layers { notes: notes.clone(), ..Layers::from(&image) })?;
    }
    assert_eq!(fs::read(folder.path().join("a.exr"))?, fs::read(folder.path().join("b.exr"))?);
    Ok(())
}

/// Reference values of IEC 61966-2-1: 255 · 0.0031308 · 12.92 = 10.3; 0.5 → 187.5 = 188; 0.18 → 117.6 = 118.
#[test]
fn a_png_follows_the_srgb_curve() {
    let pairs =
        [(0.0, 0), (0.003_130_8, 10), (0.18, 118), (0.5, 188), (1.0, 255), (7.0, 255), (-1.0, 0), (f32::NAN, 0), (f32::INFINITY, 255)];
    for (linear, byte) in pairs {
        assert_eq!(srgb(linear), byte, "{linear}");
    }
    for byte in 0..=255_u8 {
        let v = f32::from(byte) / 255.0;
        let linear = if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
        assert_eq!(srgb(linear), byte);
    }
}

#[test]
fn png_and_hdr_hold_the_picture() -> Tested {
    let folder = tempfile::tempdir()?;
    let picture = Image { width: 3, height: 2, pixels: (0..6).map(|i| [0.5, i as f32 * 0.1, -1.0]).collect() };
    for name in ["a.png", "a.HDR"] {
        let path = folder.path().join(name);
        write(&path, &Layers::from(&picture))?;
        let read = image::ImageReader::open(&path)?.with_guessed_format()?.decode()?.to_rgb32f();
        assert_eq!(read.dimensions(), (3, 2));
        for (found, wanted) in read.pixels().zip(&picture.pixels) {
            for (f, w) in found.0.iter().zip(wanted) {
                let wanted = if name == "a.png" { f32::from(srgb(*w)) / 255.0 } else { w.max(0.0) };
                assert!((f - wanted).abs() < 4e-3, "{name}: {f} {wanted}");
            }
        }
    }
    Ok(())
}

#[test]
fn a_bad_path_is_refused_and_nothing_is_left_behind() -> Tested {
    let folder = tempfile::tempdir()?;
    let image = picture(4, 4, 0.0);
    fs::create_dir(folder.path().join("folder.exr"))?;
    fs::write(folder.path().join("file"), "")?;
    for name in ["a.tiff", "a", "none/a.exr", "folder.exr", "file/a.exr", ".."] {
        let path = folder.path().join(name);
        let early = check_writable(&path).err().ok_or(name)?;
        assert_eq!(early, write(&path, &Layers::from(&image)).err().ok_or(name)?);
        assert!(!early.remedy.is_empty() && early.place.is_some() && early.source().is_none(), "{early}");
    }
    let other = picture(5, 4, 0.0);
    for (name, layer) in [("b.png", &image), ("b.exr", &other)] {
        assert!(write(&folder.path().join(name), &Layers { named: vec![Layer::rgb("x", layer)], ..Layers::from(&image) }).is_err());
    }
    // Fails in the middle of writing.
    assert!(write(&folder.path().join("b.exr"), &Layers { named: vec![Layer::rgb("λ", &image)], ..Layers::from(&image) }).is_err());
    check_writable(&folder.path().join("fine.png"))?;
    assert_eq!(files(folder.path()), ["file", "folder.exr"]);
    Ok(())
}

#[test]
fn a_failed_write_leaves_the_older_picture() -> Tested {
    let folder = tempfile::tempdir()?;
    let (path, image) = (folder.path().join("a.exr"), picture(4, 4, 0.0));
    write(&path, &Layers::from(&image))?;
    let before = fs::read(&path)?;
    assert!(write(&path, &Layers { named: vec![Layer::rgb("λ", &image)], ..Layers::from(&image) }).is_err());
    assert_eq!(fs::read(&path)?, before);
    write(&path, &Layers::from(&picture(9, 9, 1.0)))?;
    assert_ne!(fs::read(&path)?, before);
    Ok(())
}
