//! A plugin with a delta and a glossy lobe, the chance between which depends on the direction, has weights that sum to 1.
//!
//! Joins of two vertices see only the glossy lobe, so a technique (s,t) alone makes less than the whole picture, unless the path is all one
//! walk: (0,t) and (s,0). Those two must make it unweighted; and every set of joins with one of them in it must make it weighted.

use bidir_kernel::{Heuristic, Technique};

use super::{library, read};
use crate::{
    estimators::{NOT_LIGHT, agree},
    pictures::{BDPT, Subject},
    scenes::*,
    statistics::threshold,
    techniques::{switched, techniques_of, wide_lens},
};

const LONGEST: u32 = 4;
const INWARDS: &str = r#"<boolean name="flip_normals" value="true"/>"#;

fn coated() -> String {
    bsdf("coatedmirror", &(float("int_ior", 1.8) + &rgb("tint", "0.9, 0.8, 0.7") + &float("alpha", 0.4)))
}

/// A ball of coated metal that shines within, seen from within through a wide lens.
fn ball_of_light() -> Subject {
    let ball = shape("sphere", "", &[INWARDS, &coated(), &area(1.0)].concat());
    read(&[depth(LONGEST as i32), wide_lens("0.1, 0, 0.4"), ball].concat(), &library())
}

/// Whether some technique of the set makes every path: one that is all one walk.
fn makes_all(set: u32) -> bool {
    set & 0b10001 != 0
}

/// Holds every such set, weighted by one of the two heuristics, and its walks alone, unweighted, against hits of the light.
fn weights_sum_to_one(name: &str, subject: &Subject, samples: u32, heuristic: Heuristic) {
    let render = |set, heuristic, samples, seed| subject.pyramids(subject.strategy(switched(set), heuristic), samples, seed, LONGEST);
    let reference = render(0b00001, Heuristic::Balance, 4 * samples, 99);
    let sets: Vec<u32> = (2..32).filter(|set| makes_all(*set)).collect();
    let comparisons = 2 * sets.len() * LONGEST as usize;
    let mut worst: (f64, String) = (0.0, String::new());
    for set in sets {
        // Light walks seldom land on the lens: what rests on them alone takes longer, and is known less well.
        let (samples, doubt) = if set & 1 == 0 { (samples, 0.05) } else { (samples / 4, 0.02) };
        let found = render(set, heuristic, samples, u64::from(set));
        for length in 1..=LONGEST {
            let (x, wanted) = (found.length(length), reference.length(length));
            let apart = x.minus(&wanted);
            let (deviation, limit) = (apart.deviation(wanted.mean), threshold(comparisons, apart.degrees));
            let what = format!(
                "{name}, {:?} {heuristic:?}, length {length}: {:+.2} % ± {:.2} %, {deviation:.2} σ of {limit:.2}",
                switched(set),
                100.0 * apart.mean / wanted.mean,
                100.0 * apart.error / wanted.mean
            );
            assert!(wanted.mean > 0.0 && apart.error < doubt * wanted.mean, "too little to compare with: {what}");
            assert!(deviation < limit, "{what}");
            if deviation / limit > worst.0 {
                worst = (deviation / limit, what);
            }
        }
    }
    println!("of {comparisons} comparisons, worst by {heuristic:?} {}", worst.1);
}

#[test]
fn every_set_of_joins_makes_the_same_picture_by_the_balance_heuristic() {
    weights_sum_to_one("coated ball", &ball_of_light(), 2048, Heuristic::Balance);
}

#[test]
fn every_set_of_joins_makes_the_same_picture_by_the_power_heuristic() {
    weights_sum_to_one("coated ball", &ball_of_light(), 2048, Heuristic::Power);
}

/// Of each length, all light comes by hits of the light and by hits of the lens; other techniques alone lack the mirror's.
#[test]
fn each_technique_alone_makes_all_or_only_the_glossy_part() {
    let ball = ball_of_light();
    let pyramids = ball.pyramids(ball.strategy(BDPT, Heuristic::Balance), 4096, 1, LONGEST);
    for length in 1..=LONGEST {
        let weighted = pyramids.length(length);
        for technique in techniques_of(length) {
            let Technique { s, t } = technique;
            let alone = pyramids.technique(technique, 1);
            let apart = alone.minus(&weighted);
            let (deviation, limit) = (apart.deviation(weighted.mean), threshold(18, apart.degrees));
            let share = apart.mean / weighted.mean;
            println!("length {length}, {technique:?}: {:+.3} % of the weighted sum, {deviation:.2} σ of {limit:.2}", 100.0 * share);
            // A join leaves the mirror out at each surface that it touches; (1,1) touches none.
            if s == 0 || t == 0 || (s, t) == (1, 1) {
                assert!(deviation < limit && apart.error < 0.03 * weighted.mean, "length {length}, {technique:?}: {alone:?} {weighted:?}");
            } else {
                assert!(
                    share < -5.0 * apart.error / weighted.mean,
                    "length {length}, {technique:?} should lack the mirror: {alone:?} {weighted:?}"
                );
            }
        }
    }
}

#[test]
fn estimators_agree_on_a_coated_ball_in_a_room() {
    let content = [depth(6), pinhole(), room(), ball(&coated()), panel()].concat();
    agree("coated_ball", &read(&content, &library()), NOT_LIGHT);
}
