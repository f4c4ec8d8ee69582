;; A matt surface that takes its time: before each answer it counts as far as its parameter `loops` says.
;;
;; Directions are made without sines: x = 2u − 1, y = (2v − 1) √(1 − x²), z = √(1 − x² − y²), with pdf = z / (4 √(y² + z²)).
(module
  (@custom "bidir.manifest" "{\"name\": \"matt\", \"kind\": \"bsdf\", \"lobes\": [\"diffuse_reflection\"], \"params\": [{\"name\": \"reflectance\", \"type\": \"float\", \"offset\": 0, \"default\": 0.5, \"min\": 0, \"max\": 1}, {\"name\": \"loops\", \"type\": \"int\", \"offset\": 4, \"default\": 0}]}")
  (memory (export "memory") 1)
  (func (export "bidir_abi") (result i32) i32.const 65536)
  (func (export "bidir_scratch") (param i32) (result i32) i32.const 1024)

  (func $pdf (param $y f32) (param $z f32) (result f32)
    (f32.div (local.get $z) (f32.mul (f32.const 4)
      (f32.sqrt (f32.add (f32.mul (local.get $y) (local.get $y)) (f32.mul (local.get $z) (local.get $z)))))))

  (func $rgb (param $at i32) (param $x f32)
    (f32.store (local.get $at) (local.get $x))
    (f32.store offset=4 (local.get $at) (local.get $x))
    (f32.store offset=8 (local.get $at) (local.get $x)))

  ;; What it comes to is left at address 0, where nobody reads it.
  (func $count (param $params i32) (local $left i32) (local $x i32)
    (local.set $left (i32.load offset=4 (local.get $params)))
    (if (i32.gt_s (local.get $left) (i32.const 0)) (then
      (loop $on
        (local.set $x (i32.add (i32.mul (local.get $x) (i32.const 1664525)) (i32.const 1013904223)))
        (local.set $left (i32.sub (local.get $left) (i32.const 1)))
        (br_if $on (local.get $left)))))
    (i32.store (i32.const 0) (local.get $x)))

  (func (export "bsdf_eval") (param $out i32) (param $params i32) (param $carried i32)
    (param $ox f32) (param $oy f32) (param $oz f32) (param $ix f32) (param $iy f32) (param $iz f32)
    (call $count (local.get $params))
    (memory.fill (local.get $out) (i32.const 0) (i32.const 20))
    (if (i32.and (f32.gt (local.get $oz) (f32.const 0)) (f32.gt (local.get $iz) (f32.const 0))) (then
      (call $rgb (local.get $out) (f32.mul (f32.mul (f32.load (local.get $params)) (f32.const 0.31830987)) (local.get $iz)))
      (f32.store offset=12 (local.get $out) (call $pdf (local.get $iy) (local.get $iz)))
      (f32.store offset=16 (local.get $out) (call $pdf (local.get $oy) (local.get $oz))))))

  (func (export "bsdf_sample") (param $out i32) (param $params i32) (param $carried i32)
    (param $ox f32) (param $oy f32) (param $oz f32) (param $u f32) (param $v f32) (param $w f32)
    (local $x f32) (local $y f32) (local $z f32) (local $r f32)
    (call $count (local.get $params))
    (memory.fill (local.get $out) (i32.const 0) (i32.const 40))
    (local.set $x (f32.sub (f32.mul (f32.const 2) (local.get $u)) (f32.const 1)))
    (local.set $r (f32.sqrt (f32.sub (f32.const 1) (f32.mul (local.get $x) (local.get $x)))))
    (local.set $y (f32.sub (f32.mul (f32.const 2) (local.get $v)) (f32.const 1)))
    (local.set $z (f32.mul (local.get $r) (f32.sqrt (f32.sub (f32.const 1) (f32.mul (local.get $y) (local.get $y))))))
    (local.set $y (f32.mul (local.get $r) (local.get $y)))
    (if (i32.and (f32.gt (local.get $oz) (f32.const 0)) (f32.gt (local.get $z) (f32.const 0))) (then
      (f32.store (local.get $out) (local.get $x))
      (f32.store offset=4 (local.get $out) (local.get $y))
      (f32.store offset=8 (local.get $out) (local.get $z))
      ;; reflectance / π · z / pdf
      (call $rgb (i32.add (local.get $out) (i32.const 12))
        (f32.mul (f32.mul (f32.load (local.get $params)) (f32.const 1.2732395)) (local.get $r)))
      (f32.store offset=24 (local.get $out) (call $pdf (local.get $y) (local.get $z)))
      (f32.store offset=28 (local.get $out) (call $pdf (local.get $oy) (local.get $oz)))
      (i32.store offset=32 (local.get $out) (i32.const 1))))))
