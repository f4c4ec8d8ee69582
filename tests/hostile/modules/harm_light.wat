;; A dark light whose parameters "eval" and "sample" say what harm light_eval and light_emit do.
;; Does no harm (0), or runs for ever (1), calls itself for ever (2), reads outside its memory (3), gives up (4), divides by 0 (5),
;; or takes all the memory that it can get (6).
(module
  (@custom "bidir.manifest" "{\"name\": \"harm\", \"kind\": \"light\", \"emits_from\": [\"area\"], \"params\": [{\"name\": \"eval\", \"type\": \"int\", \"offset\": 0, \"default\": 0}, {\"name\": \"sample\", \"type\": \"int\", \"offset\": 4, \"default\": 0}]}")
  (memory (export "memory") 1)
  (func $deeper (param i32) (result i32) (i32.add (i32.const 1) (call $deeper (i32.add (local.get 0) (i32.const 1)))))
  (func $harm (param $how i32)
    (if (i32.eq (local.get $how) (i32.const 1)) (then (loop $ever (br $ever))))
    (if (i32.eq (local.get $how) (i32.const 2)) (then (drop (call $deeper (i32.const 0)))))
    (if (i32.eq (local.get $how) (i32.const 3)) (then (drop (i32.load (i32.const -8)))))
    (if (i32.eq (local.get $how) (i32.const 4)) (then unreachable))
    (if (i32.eq (local.get $how) (i32.const 5)) (then (drop (i32.div_s (i32.const 1) (i32.sub (local.get $how) (i32.const 5))))))
    (if (i32.eq (local.get $how) (i32.const 6))
      (then (loop $more (br_if $more (i32.ne (memory.grow (i32.const 1)) (i32.const -1)))))))
  (func (export "bidir_abi") (result i32) i32.const 65536)
  (func (export "bidir_scratch") (param i32) (result i32) i32.const 1024)
  (func (export "light_eval") (param $out i32) (param $params i32) (param f32 f32 f32 f32 f32)
    (call $harm (i32.load (local.get $params)))
    (memory.fill (local.get $out) (i32.const 0) (i32.const 16)))
  (func (export "light_emit") (param $out i32) (param $params i32) (param f32 f32 f32 f32)
    (call $harm (i32.load offset=4 (local.get $params)))
    (memory.fill (local.get $out) (i32.const 0) (i32.const 28))))
