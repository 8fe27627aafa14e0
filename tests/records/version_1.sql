BEGIN TRANSACTION;
CREATE TABLE audit (
	id INTEGER NOT NULL, 
	utc TEXT NOT NULL, 
	person TEXT NOT NULL, 
	action TEXT NOT NULL, 
	subject TEXT NOT NULL, 
	"before" TEXT NOT NULL, 
	"after" TEXT NOT NULL, 
	chain TEXT NOT NULL, 
	PRIMARY KEY (id)
);
INSERT INTO "audit" VALUES(1,'2026-11-28T06:29:59.084+00:00','(first start)','add person','person 管理','','{"active": true, "name": "管理", "name_en": "", "position": "", "position_en": "", "roles": "administrator"}','dca4de7f753c12ef364106f071a8b71350b33b9ece38f5c0db2fb1110e4b65ab');
INSERT INTO "audit" VALUES(2,'2026-11-28T06:29:59.111+00:00','管理','sign in','person 管理','','','298b8cb090b9e679cddad71aca8f664038e8e3cfc6d607517078b0e346358c56');
INSERT INTO "audit" VALUES(3,'2026-11-28T06:29:59.144+00:00','管理','add person','person the operator','','{"active": true, "name": "the operator", "name_en": "", "position": "", "position_en": "", "roles": "operator"}','a3ac3d9dfcfb5ae9a597d17f3c5092bbc191416240b93f82c95555e8509f6386');
INSERT INTO "audit" VALUES(4,'2026-11-28T06:29:59.182+00:00','the operator','sign in','person the operator','','','0a3c74e2383d5c27d02f3365d2643127410109fd907207bd66f22bcf029f4ca2');
INSERT INTO "audit" VALUES(5,'2026-11-28T06:29:59.197+00:00','管理','add person','person the verifier','','{"active": true, "name": "the verifier", "name_en": "", "position": "", "position_en": "", "roles": "verifier"}','ad47f987e57472467df7b6a2f412c5741112a045b5ed391a141e6b6079504670');
INSERT INTO "audit" VALUES(6,'2026-11-28T06:29:59.211+00:00','the verifier','sign in','person the verifier','','','09e6970f9f42b7e67f1912f0e76ad8b146147841b865b41b106e19d56ea4c61e');
INSERT INTO "audit" VALUES(7,'2026-11-28T06:29:59.220+00:00','管理','add person','person the approver','','{"active": true, "name": "the approver", "name_en": "", "position": "", "position_en": "", "roles": "approver"}','dfea18ed16eb5d653118c50ee8798f6a842cab329537d7a4189de276605e2635');
INSERT INTO "audit" VALUES(8,'2026-11-28T06:29:59.226+00:00','the approver','sign in','person the approver','','','703a3160f281dc461b56f23d3e43ca06d39f7452ff4e079e0221ad0a308bb4fd');
INSERT INTO "audit" VALUES(9,'2026-11-28T06:29:59.237+00:00','管理','set laboratory','laboratory','','{"address": "", "address_en": "", "name": "校准实验室", "name_en": "Laboratory"}','3a5bdcd32134e19149b5e7fd27e6032aac526b60fa9bff17eeea53cc00517535');
INSERT INTO "audit" VALUES(10,'2026-11-28T06:29:59.252+00:00','the operator','add','standards 1','','{"accuracy": "", "accuracy_zh": "", "certificate_number": "C-2025", "due": "2027-01-01", "kind": "table", "manufacturer": "", "model": "", "name": "Rate table", "name_zh": "转台", "serial_number": "", "traceability": ""}','f7bb26a249414b5744b573f442f5b8b55d750aab0ad5e99cae3b36e8858b8a0f');
INSERT INTO "audit" VALUES(11,'2026-11-28T06:29:59.264+00:00','the operator','add','customers 1','','{"address": "", "address_en": "", "name": "北京某研究所", "name_en": "An institute"}','58039838f19f4c918b5ce7ac84f70fb10655dd6ea47ec3b394a2f2becfacc3bd');
INSERT INTO "audit" VALUES(12,'2026-11-28T06:29:59.267+00:00','the operator','add','devices 1','','{"manufacturer": "", "model": "VN-100", "name": "航姿仪", "name_en": "", "serial_number": "7"}','6eb365839af36f4bf490f5153eb74d1d6c17dc793b5004693a94b0ec38bd0a42');
INSERT INTO "audit" VALUES(13,'2026-11-28T06:29:59.284+00:00','the operator','create job','job 2026-0001','','{"approver_id": 4, "bench_toml": "", "customer": {"address": "", "address_en": "", "id": 0, "name": "北京某研究所", "name_en": "An institute"}, "device": {"id": 0, "manufacturer": "", "model": "VN-100", "name": "航姿仪", "name_en": "", "serial_number": "7"}, "operator_id": 2, "place": "", "place_en": "", "plan_toml": "name = \"JJF\"", "received": "2026-03-01", "standard_ids": [1], "verifier_id": 3}','b22609b5189828b4b7daef96bab9c49ba202e700ce25e0b49441bbca45c78ccf');
INSERT INTO "audit" VALUES(14,'2026-11-28T06:29:59.312+00:00','the operator','move job','job 2026-0001','"draft"','{"to": "ready", "why": ""}','bc2dd3134bd28b2cefc4e60fc3636e1028e53e70802802204e6c8784c461db66');
INSERT INTO "audit" VALUES(15,'2026-11-28T06:29:59.321+00:00','the operator','add','customers 2','','{"address": "", "address_en": "", "name": "北京某研究所", "name_en": "An institute"}','ee460b61b5b1423836018a3965705b52722dcc5946df74ee31ee3c0bb89f5e6a');
INSERT INTO "audit" VALUES(16,'2026-11-28T06:29:59.323+00:00','the operator','add','devices 2','','{"manufacturer": "", "model": "VN-100", "name": "航姿仪", "name_en": "", "serial_number": "7"}','e0d8e2e214dd39838398f586b59ad377330153a11c0e831f253a45967bbd3f42');
INSERT INTO "audit" VALUES(17,'2026-11-28T06:29:59.326+00:00','the operator','create job','job 2026-0002','','{"approver_id": 4, "bench_toml": "", "customer": {"address": "", "address_en": "", "id": 0, "name": "北京某研究所", "name_en": "An institute"}, "device": {"id": 0, "manufacturer": "", "model": "VN-100", "name": "航姿仪", "name_en": "", "serial_number": "7"}, "operator_id": 2, "place": "", "place_en": "", "plan_toml": "name = \"JJF\"", "received": "2026-03-01", "standard_ids": [1], "verifier_id": 3}','8029cbf0343f396a867cbf3d0bb8f21fa06818047fd578dd34ba6e23696306e2');
INSERT INTO "audit" VALUES(18,'2026-11-28T06:29:59.337+00:00','the operator','move job','job 2026-0002','"draft"','{"to": "ready", "why": ""}','ecb22f7ea99a640aa3607b3e7deb359234fd9eabbc1ccee90f82611dbf2f7b16');
INSERT INTO "audit" VALUES(19,'2026-11-28T06:29:59.345+00:00','the operator','move job','job 2026-0001','"ready"','{"to": "running", "why": ""}','d4f688240c374020d79fac0d525009d2f2877105895f93258e0a32d4c8f65087');
INSERT INTO "audit" VALUES(20,'2026-11-28T06:29:59.352+00:00','(bench)','run','job 2026-0001','','{"detail": "", "what": "started"}','f8e049cd3deca38512392548e99b20a2fe5833f6399b8f76c6f1086b2891355c');
INSERT INTO "audit" VALUES(21,'2026-11-28T06:29:59.368+00:00','the operator','add result','job 2026-0001','','{"sha256": "ac325c299d0e68d300bb8031bb643406d1b2168bfe737452c4c79af0f047a96a"}','b33df0edc7df7d8760370da437abb18c8bd39d0bceea431a88732e444609fe67');
INSERT INTO "audit" VALUES(22,'2026-11-28T06:29:59.381+00:00','the operator','move job','job 2026-0001','"running"','{"to": "measured", "why": ""}','e295934bfea73ccac10846b55baa90d32032762f92529139e381298f7965b790');
INSERT INTO "audit" VALUES(23,'2026-11-28T06:29:59.390+00:00','the operator','sign as operator','job 2026-0001','','{"sha256": "1111111111111111111111111111111111111111111111111111111111111111"}','b1c6f4df20aa0597fc010aafc5c0fb766bc75f51418763e8f4cf711bec3d9121');
INSERT INTO "audit" VALUES(24,'2026-11-28T06:29:59.407+00:00','the operator','change','standards 1','{"accuracy": "", "accuracy_zh": "", "certificate_number": "C-2025", "due": "2027-01-01", "kind": "table", "manufacturer": "", "model": "", "name": "Rate table", "name_zh": "转台", "serial_number": "", "traceability": ""}','{"accuracy": "", "accuracy_zh": "", "certificate_number": "C-2026", "due": "2027-01-01", "kind": "table", "manufacturer": "", "model": "", "name": "Rate table", "name_zh": "转台", "serial_number": "", "traceability": ""}','8f66073c46beca86cf72f48268a65a4a8297287246897070aa07e9ac58141670');
CREATE TABLE customers (
	id INTEGER NOT NULL, 
	name TEXT NOT NULL, 
	name_en TEXT NOT NULL, 
	address TEXT NOT NULL, 
	address_en TEXT NOT NULL, 
	PRIMARY KEY (id)
);
INSERT INTO "customers" VALUES(1,'北京某研究所','An institute','','');
INSERT INTO "customers" VALUES(2,'北京某研究所','An institute','','');
CREATE TABLE devices (
	id INTEGER NOT NULL, 
	name TEXT NOT NULL, 
	name_en TEXT NOT NULL, 
	manufacturer TEXT NOT NULL, 
	model TEXT NOT NULL, 
	serial_number TEXT NOT NULL, 
	PRIMARY KEY (id)
);
INSERT INTO "devices" VALUES(1,'航姿仪','','','VN-100','7');
INSERT INTO "devices" VALUES(2,'航姿仪','','','VN-100','7');
CREATE TABLE job_standards (
	job_id INTEGER NOT NULL, 
	standard_id INTEGER NOT NULL, 
	as_used TEXT NOT NULL, 
	UNIQUE (job_id, standard_id), 
	FOREIGN KEY(job_id) REFERENCES jobs (id), 
	FOREIGN KEY(standard_id) REFERENCES standards (id)
);
INSERT INTO "job_standards" VALUES(1,1,'{"id": 1, "kind": "table", "name": "Rate table", "name_zh": "转台", "manufacturer": "", "model": "", "serial_number": "", "accuracy": "", "accuracy_zh": "", "certificate_number": "C-2025", "due": "2027-01-01", "traceability": ""}');
INSERT INTO "job_standards" VALUES(2,1,'');
CREATE TABLE jobs (
	id INTEGER NOT NULL, 
	number VARCHAR NOT NULL, 
	state VARCHAR NOT NULL, 
	customer_id INTEGER NOT NULL, 
	device_id INTEGER NOT NULL, 
	received DATE NOT NULL, 
	place TEXT NOT NULL, 
	place_en TEXT NOT NULL, 
	plan_toml TEXT NOT NULL, 
	bench_toml TEXT NOT NULL, 
	folder TEXT NOT NULL, 
	certificate_number TEXT NOT NULL, 
	operator_id INTEGER, 
	verifier_id INTEGER, 
	approver_id INTEGER, 
	revision INTEGER NOT NULL, 
	calibrated DATE, 
	issued DATE, 
	PRIMARY KEY (id), 
	UNIQUE (number), 
	FOREIGN KEY(customer_id) REFERENCES customers (id), 
	FOREIGN KEY(device_id) REFERENCES devices (id), 
	FOREIGN KEY(operator_id) REFERENCES people (id), 
	FOREIGN KEY(verifier_id) REFERENCES people (id), 
	FOREIGN KEY(approver_id) REFERENCES people (id)
);
INSERT INTO "jobs" VALUES(1,'2026-0001','measured',1,1,'2026-03-01','','','name = "JJF"','','','AL-2026-0001',2,3,4,0,'2026-11-28',NULL);
INSERT INTO "jobs" VALUES(2,'2026-0002','ready',2,2,'2026-03-01','','','name = "JJF"','','','AL-2026-0002',2,3,4,0,NULL,NULL);
CREATE TABLE laboratory (
	id INTEGER NOT NULL, 
	name TEXT NOT NULL, 
	name_en TEXT NOT NULL, 
	address TEXT NOT NULL, 
	address_en TEXT NOT NULL, 
	PRIMARY KEY (id)
);
INSERT INTO "laboratory" VALUES(1,'校准实验室','Laboratory','','');
CREATE TABLE people (
	id INTEGER NOT NULL, 
	name VARCHAR NOT NULL, 
	name_en TEXT NOT NULL, 
	position TEXT NOT NULL, 
	position_en TEXT NOT NULL, 
	roles TEXT NOT NULL, 
	password_hash TEXT NOT NULL, 
	active BOOLEAN NOT NULL, 
	failures INTEGER NOT NULL, 
	locked_until TEXT NOT NULL, 
	PRIMARY KEY (id), 
	UNIQUE (name)
);
INSERT INTO "people" VALUES(1,'管理','','','','administrator','$argon2id$v=19$m=8,t=1,p=1$Lla9O6WvY4jvOqxcM7NzTg$qcaTFE0AX1f4sT0bLFBBi62+EwtfzMFNUbMh3g+KsCE',1,0,'');
INSERT INTO "people" VALUES(2,'the operator','','','','operator','$argon2id$v=19$m=8,t=1,p=1$dX9JZI60VlZvFeYfkPqKLg$3VN2zipHaiDy9UjI+nHr/NfTXYEOafJ7+UPFJCwWpt0',1,0,'');
INSERT INTO "people" VALUES(3,'the verifier','','','','verifier','$argon2id$v=19$m=8,t=1,p=1$+Saloj91MZEJRefrCrwCbQ$duqzIepkEqXkdk4cnMTL7n1DqMRHbRK+iTX+iKmMNtc',1,0,'');
INSERT INTO "people" VALUES(4,'the approver','','','','approver','$argon2id$v=19$m=8,t=1,p=1$nG8PPE+2saP4mO+IfGCxxA$F0CaMteV2QasmYR0Ll9Usn6341M7wyuskrHgdb3CsvM',1,0,'');
CREATE TABLE results (
	id INTEGER NOT NULL, 
	job_id INTEGER NOT NULL, 
	utc TEXT NOT NULL, 
	person TEXT NOT NULL, 
	json TEXT NOT NULL, 
	sha256 TEXT NOT NULL, 
	PRIMARY KEY (id), 
	FOREIGN KEY(job_id) REFERENCES jobs (id)
);
INSERT INTO "results" VALUES(1,1,'2026-11-28T06:29:59.361+00:00','the operator','{"K": 1.0}','ac325c299d0e68d300bb8031bb643406d1b2168bfe737452c4c79af0f047a96a');
CREATE TABLE runs (
	id INTEGER NOT NULL, 
	job_id INTEGER NOT NULL, 
	utc TEXT NOT NULL, 
	what TEXT NOT NULL, 
	detail TEXT NOT NULL, 
	PRIMARY KEY (id), 
	FOREIGN KEY(job_id) REFERENCES jobs (id)
);
INSERT INTO "runs" VALUES(1,1,'2026-11-28T06:29:59.351+00:00','started','');
CREATE TABLE signatures (
	id INTEGER NOT NULL, 
	job_id INTEGER NOT NULL, 
	role TEXT NOT NULL, 
	person TEXT NOT NULL, 
	utc TEXT NOT NULL, 
	file TEXT NOT NULL, 
	sha256 TEXT NOT NULL, 
	revision INTEGER NOT NULL, 
	PRIMARY KEY (id), 
	UNIQUE (job_id, revision, role), 
	FOREIGN KEY(job_id) REFERENCES jobs (id)
);
INSERT INTO "signatures" VALUES(1,1,'operator','the operator','2026-11-28T06:29:59.388+00:00','c.pdf','1111111111111111111111111111111111111111111111111111111111111111',0);
CREATE TABLE standards (
	id INTEGER NOT NULL, 
	kind TEXT NOT NULL, 
	name TEXT NOT NULL, 
	name_zh TEXT NOT NULL, 
	manufacturer TEXT NOT NULL, 
	model TEXT NOT NULL, 
	serial_number TEXT NOT NULL, 
	accuracy TEXT NOT NULL, 
	accuracy_zh TEXT NOT NULL, 
	certificate_number TEXT NOT NULL, 
	traceability TEXT NOT NULL, 
	due DATE, 
	PRIMARY KEY (id)
);
INSERT INTO "standards" VALUES(1,'table','Rate table','转台','','','','','','C-2026','','2027-01-01');
CREATE TABLE version (
	number INTEGER NOT NULL
);
INSERT INTO "version" VALUES(1);
CREATE TRIGGER runs_no_update BEFORE UPDATE ON runs BEGIN SELECT RAISE(ABORT, 'runs is append-only'); END;
CREATE TRIGGER runs_no_delete BEFORE DELETE ON runs BEGIN SELECT RAISE(ABORT, 'runs is append-only'); END;
CREATE TRIGGER runs_no_insert BEFORE INSERT ON runs WHEN EXISTS (SELECT 1 FROM runs WHERE id = NEW.id) BEGIN SELECT RAISE(ABORT, 'runs is append-only'); END;
CREATE TRIGGER results_no_update BEFORE UPDATE ON results BEGIN SELECT RAISE(ABORT, 'results is append-only'); END;
CREATE TRIGGER results_no_delete BEFORE DELETE ON results BEGIN SELECT RAISE(ABORT, 'results is append-only'); END;
CREATE TRIGGER results_no_insert BEFORE INSERT ON results WHEN EXISTS (SELECT 1 FROM results WHERE id = NEW.id) BEGIN SELECT RAISE(ABORT, 'results is append-only'); END;
CREATE TRIGGER signatures_no_update BEFORE UPDATE ON signatures BEGIN SELECT RAISE(ABORT, 'signatures is append-only'); END;
CREATE TRIGGER signatures_no_delete BEFORE DELETE ON signatures BEGIN SELECT RAISE(ABORT, 'signatures is append-only'); END;
CREATE TRIGGER signatures_no_insert BEFORE INSERT ON signatures WHEN EXISTS (SELECT 1 FROM signatures WHERE id = NEW.id) BEGIN SELECT RAISE(ABORT, 'signatures is append-only'); END;
CREATE TRIGGER audit_no_update BEFORE UPDATE ON audit BEGIN SELECT RAISE(ABORT, 'audit is append-only'); END;
CREATE TRIGGER audit_no_delete BEFORE DELETE ON audit BEGIN SELECT RAISE(ABORT, 'audit is append-only'); END;
CREATE TRIGGER audit_no_insert BEFORE INSERT ON audit WHEN EXISTS (SELECT 1 FROM audit WHERE id = NEW.id) BEGIN SELECT RAISE(ABORT, 'audit is append-only'); END;
COMMIT;
