;; Answers whatever its parameter block holds: 20 bytes for bsdf_eval, the next 40 for bsdf_sample.
(module
  (@custom "bidir.manifest" "{\"name\": \"echo\", \"kind\": \"bsdf\", \"lobes\": [\"diffuse_reflection\", \"delta_reflection\"]}")
  (memory (export "memory") 1)
  (func (export "bidir_abi") (result i32) i32.const 65536)
  (func (export "bidir_scratch") (param i32) (result i32) i32.const 1024)
  (func (export "bsdf_eval") (param $out i32) (param $params i32) (param i32 f32 f32 f32 f32 f32 f32)
    (memory.copy (local.get $out) (local.get $params) (i32.const 20)))
  (func (export "bsdf_sample") (param $out i32) (param $params i32) (param i32 f32 f32 f32 f32 f32 f32)
    (memory.copy (local.get $out) (i32.add (local.get $params) (i32.const 20)) (i32.const 40))))
