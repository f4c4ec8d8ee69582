//! Every hard case holds, natively, in the sandbox and by the f64 twin; and undoing a guard is noticed.

mod undone;

use bidir_tests::hard::{self, Form, Held};

fn holds(number: u32) {
    let case = hard::case(number);
    let all: Vec<Held> = [Form::Native, Form::Sandbox].into_iter().flat_map(case.run).chain(hard::twin::of_case(number)).collect();
    assert!(!all.is_empty(), "case {number} asks nothing");
    for held in &all {
        println!("{number}, {}: {:e}, at most {:e}", held.what, held.worst, held.bound);
    }
    let failed: Vec<_> = all.iter().filter(|held| !held.holds()).collect();
    assert!(failed.is_empty(), "case {number}, {}: {failed:#?}", case.what);
}

macro_rules! cases {
    ($($name:ident = $number:literal,)*) => {
        $(
            #[test]
            fn $name() {
                holds($number);
            }
        )*
        const NUMBERS: &[u32] = &[$($number),*];
    };
}

// Rows 17, 53 and 55 of the table wait for media and merging.
cases! {
    case_01 = 1,
    case_02 = 2,
    case_03 = 3,
    case_04 = 4,
    case_05 = 5,
    case_06 = 6,
    case_07 = 7,
    case_08 = 8,
    case_09 = 9,
    case_10 = 10,
    case_11 = 11,
    case_12 = 12,
    case_13 = 13,
    case_14 = 14,
    case_15 = 15,
    case_16 = 16,
    case_18 = 18,
    case_19 = 19,
    case_20 = 20,
    case_21 = 21,
    case_22 = 22,
    case_23 = 23,
    case_24 = 24,
    case_25 = 25,
    case_26 = 26,
    case_27 = 27,
    case_28 = 28,
    case_29 = 29,
    case_30 = 30,
    case_31 = 31,
    case_32 = 32,
    case_33 = 33,
    case_34 = 34,
    case_35 = 35,
    case_36 = 36,
    case_37 = 37,
    case_38 = 38,
    case_39 = 39,
    case_40 = 40,
    case_41 = 41,
    case_42 = 42,
    case_43 = 43,
    case_44 = 44,
    case_45 = 45,
    case_46 = 46,
    case_47 = 47,
    case_48 = 48,
    case_49 = 49,
    case_50 = 50,
    case_51 = 51,
    case_52 = 52,
    case_54 = 54,
    case_56 = 56,
    case_57 = 57,
    case_58 = 58,
    case_59 = 59,
    case_60 = 60,
    case_61 = 61,
    case_62 = 62,
    case_63 = 63,
    case_64 = 64,
    case_65 = 65,
    case_66 = 66,
    case_67 = 67,
    case_68 = 68,
}

#[test]
fn every_case_has_its_test_and_every_scene_its_case() {
    assert_eq!(hard::cases().iter().map(|case| case.number).collect::<Vec<_>>(), NUMBERS);
    let scenes = std::fs::read_dir(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("hard/scenes")).expect("scenes");
    for file in scenes.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()) {
        let Some((number, _)) = file.split_once('_').filter(|(number, _)| number.parse::<u32>().is_ok()) else { continue };
        assert!(NUMBERS.contains(&number.parse().expect("a number")), "{file} belongs to no case");
    }
}
