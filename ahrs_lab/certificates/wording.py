"""The fixed words of certificate and original record, Chinese and English side by side.

Annex C's words and order hold for the result sheet; the standard's terms everywhere.
"""

from __future__ import annotations

from ahrs_lab.certificates.documents import Words

TITLE = Words("校准证书", "CALIBRATION CERTIFICATE")
CERTIFICATE_NUMBER = Words("证书编号", "Certificate No.")
PAGE_OF = Words("第  {page}  页  共  {pages}  页", "Page {page} of {pages}")
FOOTER = Words(
    "本证书结果仅对所校准的对象有效。未经本实验室书面批准，不得部分复制。",
    "The results relate only to the item calibrated. Not to be reproduced except in full without the written "
    "approval of the laboratory.",
)
DEMONSTRATION = Words("演示 —— 非有效证书", "DEMONSTRATION — not a valid certificate")

# Front page, clause 8 b), e) to g), i), k), l)
CUSTOMER = Words("送校单位", "Customer")
ADDRESS = Words("地址", "Address")
DEVICE = Words("被校对象", "Item calibrated")
MANUFACTURER = Words("制造厂", "Manufacturer")
MODEL = Words("型号规格", "Model")
SERIAL = Words("出厂编号", "Serial number")
RECEIVED = Words("接收日期", "Received")
CALIBRATED = Words("校准日期", "Calibrated")
ISSUED = Words("签发日期", "Issued")
ISSUED_BY_SIGNATURE = Words("以签发人数字签名日期为准", "date of the approver's digital signature")
INTERVAL = Words("建议复校间隔", "Recommended interval")
MONTHS = Words("{months} 个月", "{months} months")
PROCEDURE = Words("校准依据", "Procedure")
PLACE = Words("校准地点", "Place")
ENVIRONMENT = Words("环境条件", "Environment")
ENVIRONMENT_VALUE = Words(
    "温度 ({temperature}) °C，相对湿度 ({humidity}) %",
    "temperature ({temperature}) °C, humidity ({humidity}) %RH",
)
NOT_RECORDED = Words("未记录", "not recorded")
DECLARED_PLACE = Words("场地条件", "Site conditions")
NOT_DECLARED = Words("未声明", "not declared")
EARTH_RESISTANCE = Words("接地电阻 {value} Ω", "Earth resistance {value} Ω")
EARTH_NOT_DECLARED = Words("接地电阻未声明", "Earth resistance not declared")
ISOLATED = Words("转台置于独立地基上", "table on an isolated foundation")
NOT_ISOLATED = Words("转台未置于独立地基上", "table not on an isolated foundation")
FOUNDATION_NOT_DECLARED = Words("转台地基未声明", "foundation of the table not declared")
CLAUSE_6 = Words("校准条件", "Clause 6")
CLAUSE_6_MET = Words(
    "环境、场地和测量标准符合规范第 6 章的要求。",
    "Room, site and measurement standards met the conditions of clause 6.",
)
CLAUSE_6_AS_KNOWN = Words(
    "已知的校准条件符合规范第 6 章的要求。",
    "As far as they are known, the conditions of clause 6 were met.",
)
CLAUSE_6_VIOLATED = Words(
    "未全部符合规范第 6 章的要求，见“与规范的偏离”。",
    "The conditions of clause 6 were not all met: see “Deviations from the standard”.",
)
OPERATOR = Words("校准员", "Operator")
VERIFIER = Words("核验员", "Verifier")
APPROVER = Words("签发人", "Approver")
TO_BE_SIGNED = Words("待数字签名", "to be signed digitally")
SIGNED = Words("已数字签名", "Digitally signed")
SEAL = Words("校准专用章", "Calibration seal")

# Standards, clause 8 h)
STANDARDS = Words("校准所用测量标准", "Measurement standards used")
STANDARD_NAME = Words("名称", "Name")
STANDARD_SERIAL = Words("出厂编号", "Serial No.")
STANDARD_ACCURACY = Words("准确度 / 等级", "Accuracy / class")
STANDARD_CERTIFICATE = Words("证书编号", "Certificate No.")
STANDARD_DUE = Words("有效期至", "Valid until")
STANDARD_MODEL = Words("型号规格", "Model")
NO_STANDARDS = Words("未登记测量标准。", "No measurement standard was entered.")

# Results, annex C
RESULTS = Words("航姿仪校准结果", "Results of the calibration")
SCALE_FACTOR = Words("标度因数", "Scale factor")
ZERO_OFFSET = Words("零偏", "Zero offset")
MISALIGNMENT = Words("失准角", "Misalignment")
QUANTITY = Words("参数", "Quantity")
VALUE = Words("校准值", "Value")
EXPANDED = Words("扩展不确定度 U", "Exp. unc. U")
EXPANDED_SHORT = Words("U", "U")
COVERAGE = Words("k", "k")
RANGE = Words("速率范围", "Range")
SCALE_FACTOR_NAMES = {
    "x": Words("X 轴标度因数", "Scale factor, X axis"),
    "y": Words("Y 轴标度因数", "Scale factor, Y axis"),
    "z": Words("Z 轴标度因数", "Scale factor, Z axis"),
}
ZERO_OFFSET_NAMES = {
    "x": Words("航向角零偏", "Heading zero offset"),
    "y": Words("俯仰角零偏", "Pitch zero offset"),
    "z": Words("横滚角零偏", "Roll zero offset"),
}
MISALIGNMENT_NAMES = {
    key: Words(
        f"{key[1].upper()} 轴对 {key[0].upper()} 轴失准角",
        f"Misalignment {key[1].upper()} to {key[0].upper()}",
    )
    for key in ("yx", "zx", "xy", "zy", "xz", "yz")
}
REPEATABILITY = Words("重复性", "Repeatability")
NOT_CALIBRATED = Words("未校准", "not calibrated")
LINEARITY = Words("线性度与不对称性（参考）", "Nonlinearity and asymmetry (informative)")
AXIS = Words("轴", "Axis")
NONLINEARITY = Words("非线性", "Nonlinearity")
ASYMMETRY = Words("不对称性", "Asymmetry")
ASYMMETRY_U = Words("u（噪声）", "u (noise)")
FITTED_ZERO = Words("拟合零位 F_{0} ± U", "Fitted zero F_{0} ± U")
LINEARITY_NOTE = Words(
    "非线性与不对称性为参考值，不给出 U；u（噪声）为不对称性的标准不确定度中各平均值自身噪声的部分。",
    "Nonlinearity and asymmetry are informative and have no U; u (noise) is the part of the asymmetry's "
    "standard uncertainty that comes from the noise of the means themselves.",
)

# Uncertainty, clause 8 j)
UNCERTAINTY = Words("测量不确定度的说明", "Statement of uncertainty")
BY_GUM = Words(
    "测量不确定度按 JJF 1059.1（JCGM 100，GUM）评定。扩展不确定度 U = k u_{c}，包含因子 k 由有效自由度的 "
    "t 分布得出，"
    "列于各结果旁；包含概率约为 95 %。结果修约到与 U 相同的末位，U 取两位有效数字。",
    "Uncertainty is evaluated to JCGM 100 (GUM). The expanded uncertainty is U = k u_{c}; the coverage "
    "factor k follows "
    "from the t-distribution with the effective degrees of freedom and is stated beside each result; the "
    "coverage "
    "probability is about 95 %. U has two significant digits, values are rounded to the same place.",
)
FROM_MONTE_CARLO = Words(
    "例外：{keys} 的 GUM 区间未通过蒙特卡洛法的验证（JCGM 101 第 8 章）且偏短；其 U 取以校准值为中心、覆盖试"
    "验的 95 % 对称包含区间的半宽，k = U/u_{{c}}。",
    "Exception: {keys}, whose GUM interval is not validated by Monte Carlo (JCGM 101, clause 8) and too "
    "short: U is the half-width about the value that covers the trials' symmetric 95 % coverage interval, "
    "k = U/u_{{c}}.",
)
LONGER_THAN_MONTE_CARLO = Words(
    "例外：{keys} 的 GUM 区间未通过蒙特卡洛法的验证（JCGM 101 第 8 章）而偏长；U 仍按 GUM 给出，其包含概率"
    "大于 95 %。",
    "Exception: {keys}, whose GUM interval is not validated by Monte Carlo (JCGM 101, clause 8) and too "
    "long: U is the GUM's, and its coverage probability is more than 95 %.",
)
NOT_VALIDATED = Words(
    "例外：{keys} 的 GUM 区间未通过蒙特卡洛法的验证（JCGM 101 第 8 章），其包含概率可能小于 95 %；请重"
    "新评定。",
    "Exception: {keys}, whose GUM interval is not validated by Monte Carlo (JCGM 101, clause 8): its "
    "coverage probability may be less than 95 %; evaluate the recording again.",
)
NOTE_MONTE_CARLO = Words(
    "U 取自蒙特卡洛法的试验（JCGM 101 第 8.3 条），因 GUM 的 U 未通过验证且偏短。",
    "U is from the Monte Carlo trials (JCGM 101, 8.3), because the GUM's was not validated and too short.",
)
BY_ANNEX_A = Words(
    "测量不确定度按 JJF 1536—2015 附录 A 评定，包含因子 k = 2，包含概率约为 95 %。结果修约到与 U 相同的末"
    "位，U 取两位有效数字。",
    "Uncertainty is evaluated by annex A of JJF 1536-2015 with the coverage factor k = 2; the coverage "
    "probability is "
    "about 95 %. U has two significant digits, values are rounded to the same place.",
)
ROUNDED_UP = Words("U 修约时只入不舍。", "U is rounded up.")
MEANING_OF_B = Words(
    "零偏 B 为所述条件下各记录时段输出的平均值，其 U 不包含他日的变化（零偏稳定性、通电重复性）。",
    "B is the mean offset over the recorded dwells under the conditions stated. Its U does not cover "
    "what B may be on another day (bias instability, turn-on repeatability).",
)
MEANING_OF_B_WITH = Words(
    "零偏 B 为所述条件下各记录时段输出的平均值；应委托方要求，其 U 包含“重复性”一栏所示的他日变化。",
    "B is the mean offset over the recorded dwells under the conditions stated. As the customer asked, its U "
    "includes what B may be on another day, as the repeatability beside it shows.",
)
REPEATABILITY_BY_ALLAN = Words(
    "零偏表中的“重复性”为时长 T 处的 Allan 标准差，只反映零偏稳定性，不含通电重复性。",
    "The repeatability beside B is the Allan deviation at the dwell T: it shows the bias instability, not "
    "the turn-on repeatability.",
)
REPEATABILITY_BY_CYCLES = Words(
    "零偏表中的“重复性”为 {count} 次断电重复测量所得 B 的单次实验标准差。",
    "The repeatability beside B is the experimental standard deviation of a single B, from {count} "
    "measurements with power off between them.",
)
TRACEABILITY = Words(
    "测量结果通过上列测量标准溯源；不确定度汇总中标 * 的分量为假定值，无证书支持。",
    "Results are traceable through the measurement standards listed above; contributions marked * in the "
    "uncertainty summary are assumed and not supported by a certificate.",
)
ASSUMED_SOME = Words(
    "{keys} 的 B 类方差大部分（超过 50 %）来自假定值，其溯源性未得到证明。",
    "Of {keys} most of the type B variance (more than 50 %) is from assumed figures: traceability of those "
    "is not shown.",
)
ASSUMED_ALL = Words(
    "测量结果的溯源性未得到证明：所有结果的 B 类方差大部分（超过 50 %）来自假定值（不确定度汇总中标 *），"
    "无证书支持。",
    "Traceability of the results is not shown: of every one most of the type B variance (more than 50 %) is "
    "from assumed figures (marked * in the uncertainty summary), which no certificate supports.",
)
TRACED_BY = Words("测量标准的溯源机构：{bodies}。", "The standards are traced through {bodies}.")
NOT_TRACEABLE = Words(
    "测量结果的溯源性未得到证明：所用测量标准不全、缺少证书编号或已超过有效期。",
    "Traceability of the results is not shown: a measurement standard is missing, has no certificate number "
    "or due date, or is overdue.",
)
DEMONSTRATION_NOT_TRACEABLE = Words(
    "本文件为演示，测量结果不具有溯源性。", "This is a demonstration: its results are not traceable."
)

# Conditions of the calibration
CONDITIONS = Words("校准条件与方法", "Conditions and methods")
RATES = Words("校准速率点", "Rates")
RATE_SOURCE = Words("速率取值", "Rate used")
RATE_DEMANDED = Words("转台指令速率", "demanded rate of the table")
RATE_TABLE = Words("转台实测转角除以时间", "angle turned by the table over time")
ZERO_OFFSET_SCHEDULE = Words("零偏方法", "Schedule")
SCHEDULE_OF_AXES = Words("{axes} 轴：{schedule}", "{axes}: {schedule}")
SCHEDULES = {
    "standard": Words(
        "四位置法，标准程序（每轴四个位置）", "four positions, standard schedule (four positions per axis)"
    ),
    "combined": Words(
        "四位置法，组合程序（同一组四个位置得出三轴零偏；非标准默认程序）",
        "four positions, combined schedule (the same four positions give all three axes; not the "
        "standard's default)",
    ),
    "multi-position": Words("多位置法（7.2.2）", "multi-position method (7.2.2)"),
}
DWELL = Words("每位置时间 T", "Dwell T")
TURNS = Words("失准角转动", "Turns")
TURNS_VALUE = Words("±{turns} 周，{rate} °/s", "±{turns} turns at {rate} °/s")
AXES_TIED = Words("轴的定义", "Axes")
AXES_VALUE = Words("X 航向，Y 俯仰，Z 横滚", "X heading, Y pitch, Z roll")
SITE = Words("实验室位置", "Site")
LATITUDE = Words("纬度 {latitude}°", "latitude {latitude}°")
SAMPLE_RATE = Words("采样频率", "Sampling rate")
RECORDING = Words("记录包 SHA-256", "SHA-256")
SOFTWARE = Words("软件", "Software")
DEVIATIONS = Words("与规范的偏离", "Deviations from the standard")
NO_DEVIATIONS = Words("无。", "None.")
REMARKS = Words("备注", "Remarks")
MORE_REMARKS = Words("另有 {count} 条，见原始记录。", "{count} more are in the original record.")
USE = Words("结果的使用", "How to apply the results")
USE_TEXT = Words(
    "航姿仪模型 N = M A + B T，M = I + L（L 对角线为零）；补偿时 A = M^{−1} (N − B T)，其中 N 为按标度因"
    "数换算为度的输出角，"
    "A 为输入角，T 为时间。",
    "The unit is modelled as N = M A + B T with M = I + L (L has a zero diagonal); to compensate, A = "
    "M^{−1} (N − B T), "
    "where N are the output angles scaled to degrees by the scale factor, A the input angles and T the time.",
)
USE_AS_DELIVERED = Words(
    "B、L 得自未除以标度因数的输出；N 除以标度因数（化为无量纲）后，B 和 L 的相应行也须除以它。",
    "B and L are of the output as delivered: where N has been divided by the (dimensionless) scale factor, "
    "divide B and the row of L by it too.",
)

# Footnotes: where the print of the standard cannot be followed literally
NOTE_SYMBOLS = Words(
    "名称与顺序按附录 C；符号按式 (7)：第一下标为输出轴，第二下标为转动轴（附录 C 将“X 轴对 Y 轴”印作 "
    "L_{xy}；式 (1)、(9) 的说明和"
    " 7.3.1、表 3、式 (17) 的下标前后不一，此处统一）。",
    "Words and order of annex C, symbols of equation (7): first index the output, second the turned axis "
    "(annex C prints "
    "'X to Y' as L_{xy}; the indices in the legend of (1), in (9), 7.3.1, table 3 and (17) are not "
    "consistent and are "
    "unified here).",
)
NOTE_DIVISORS = Words(
    "式 (7)～(9)、(16)、(17)、(A.4) 的除数印刷时缺括号，此处按 /(2 × 360 × n) 与 /(4T) 计算。",
    "Equations (7) to (9), (16), (17), (A.4) are printed without brackets around the divisor; computed "
    "here with "
    "/(2 × 360 × n) and /(4T).",
)
NOTE_RATIO = Words(
    "规范称失准角的单位为度，而式 (7) 得出比值，小角度时即弧度；两者均给出。",
    "The standard calls L an angle in degrees, but (7) yields a ratio, which for small angles is in "
    "radians; both are "
    "given.",
)
NOTE_PRODUCT = Words(
    "式 (2) 中逆矩阵与向量之间印作“+”，应为乘积。",
    "Equation (2) prints '+' where the inverse matrix multiplies the vector.",
)
NOTE_SENSITIVITY = Words(
    "灵敏系数按式 (16)、(7) 求出（∂B/∂N = 1/(4T)，∂L/∂N = ±1/(720n)）；式 (A.5) 后印出的 450 不适用。",
    "Sensitivities follow (16) and (7) (∂B/∂N = 1/(4T), ∂L/∂N = ±1/(720n)); the 450 printed after (A.5) "
    "does not apply.",
)
NOTE_ANNEX_A = Words(
    "附录 A 省略灵敏系数，将相等的重复性分量线性相加，并以整个量化步长除以 √3；此处照附录 A 执行，其 U 与"
    "按 GUM 评定者不可比。",
    "Annex A drops the sensitivities, adds equal repeatability terms linearly and divides the full "
    "quantisation step by "
    "√3; followed here as printed, so this U does not compare with one evaluated by the GUM.",
)

# Annex page
ANNEX = Words("附页：拟合残差与不确定度汇总", "Annex: residuals and uncertainty summary")
RESIDUALS = Words("标度因数拟合残差 v_{j}", "Residuals v_{j} of the scale-factor fit")
RESIDUALS_X = Words("输入速率 Ω / (°/s)", "input rate Ω / (°/s)")
RESIDUALS_Y = Words("v_{j} / max|F_{j}| / 10^{−6}", "v_{j} / max|F_{j}| / 10^{−6}")
RESIDUALS_NOTE = Words("误差线：±2 倍平均值的标准误差。", "Error bars: ±2 standard errors of the mean.")
POSITIONS = Words("零偏各位置输出", "Zero-offset positions")
POSITIONS_X = Words("位置", "position")
AZIMUTH_X = Words("方位角 / °", "azimuth / °")
POSITIONS_Y = Words("(N_{i} / T − B) / (°/h)", "(N_{i} / T − B) / (°/h)")
HARMONIC_NOTE = Words(
    "曲线为地球自转水平分量的一次谐波：拟合幅值 {amplitude} °/h，应为 {expected} °/h；北向误差 {phase}°。",
    "Curve: first harmonic of the horizontal Earth rate: fitted amplitude {amplitude} °/h, expected "
    "{expected} °/h; "
    "north error {phase}°.",
)
BUDGET = Words("测量不确定度汇总", "Uncertainty summary")
SOURCE = Words("来源", "Source")
KIND = Words("类", "Type")
COMBINED = Words("合成标准不确定度 u_{c}", "Combined standard uncertainty\u00a0u_{c}")
COVERAGE_FACTOR = Words("包含因子 k", "Coverage factor k")
EXPANDED_UNCERTAINTY = Words("扩展不确定度 U", "Expanded uncertainty U")
BUDGET_NOTE = Words(
    "各列为该来源对结果的标准不确定度贡献 |c| u(x)；A、B 为评定类别。* 为假定值，无证书支持。",
    "Columns: contribution |c| u(x) of the source to the result, one standard deviation; A, B: type of "
    "evaluation. "
    "* assumed, not supported by a certificate.",
)
BUDGET_CERTIFICATES = Words(
    "由标准器证书给出：{numbers}。", "Stated by the standards' certificates: {numbers}."
)

# Annex pages with the budgets in full
BUDGETS_ANNEX = Words("附页：不确定度评定", "Annex: uncertainty budgets")
SYMBOL = Words("符号", "Symbol")
DISTRIBUTION = Words("分布", "Distribution")
SHARE = Words("占比 / %", "Share / %")
DISTRIBUTIONS = {
    "normal": Words("正态", "normal"),
    "rectangular": Words("矩形", "rectangular"),
    "triangular": Words("三角", "triangular"),
    "arcsine": Words("反正弦", "arcsine"),
    "t": Words("t 分布", "t"),
}
BUDGETS_NOTE = Words(
    "u(x) 为来源自身的标准不确定度；|c| u(x) 为其对结果的贡献；占比为其在 u_{c}^{2} 中所占部分；ν 为自由度，"
    "合成行中为有效自由度。* 为假定值，无证书支持。",
    "u(x): standard uncertainty of the source in its own unit; |c| u(x): its contribution to the result; "
    "share: its part of u_{c}^{2}; ν: degrees of freedom, the effective ones in the line of u_{c}. "
    "* assumed, not supported by a certificate.",
)
BUDGETS_CORRELATED = Words(
    "相关的来源已按 JCGM 100 式 (13) 计入相关性；其占比可为负。",
    "Sources that are correlated are combined by equation (13) of JCGM 100; a share may then be negative.",
)
CHECK = Words(
    "蒙特卡洛法（JCGM 101），{trials} 次试验：平均值 {mean}，u = {u}；95 % 包含区间：对称 {symmetric}，最短 "
    "{shortest}。",
    "Monte Carlo (JCGM 101), {trials} trials: mean {mean}, u = {u}; 95 % coverage intervals: symmetric "
    "{symmetric}, shortest {shortest}.",
)
CHECK_VALIDATED = Words("±U 经第 8 章验证（δ = {delta}）。", "± U is validated by clause 8 (δ = {delta}).")
CHECK_NOT_VALIDATED = Words(
    "±U 未通过第 8 章的验证（δ = {delta}）。", "± U is not validated by clause 8 (δ = {delta})."
)
CHECK_WIDENED = Words(
    "GUM 的 ±U（{gum}）未通过第 8 章的验证（δ = {delta}）且偏短；U 取覆盖对称区间的半宽。",
    "The GUM's ± U ({gum}) is not validated by clause 8 (δ = {delta}) and too short; U is the half-width "
    "that covers the symmetric interval.",
)

# Original record (原始记录) and plots
RECORD_TITLE = Words("校准原始记录", "ORIGINAL RECORD OF CALIBRATION")
PLOTS_TITLE = Words("校准数据图", "PLOTS OF THE CALIBRATION")
ANALYSIS = Words("惯性系统分析", "Analysis of inertial systems")
ANALYSIS_FOOTER = Words(
    "由 {software} 生成的分析报告，不是校准证书。",
    "Report of an analysis made by {software}; not a calibration certificate.",
)
ANALYSIS_WARNING = Words("警告：", "Warning: ")
RECORD_NUMBER = Words("记录编号", "Record No.")
RECORD_FOOTER = Words(
    "本记录由软件自记录包生成，数值未修约至不确定度。",
    "Made by the software from the recording; values are not rounded to their uncertainty.",
)
DEMONSTRATION_RECORD = Words("演示 —— 非有效记录", "DEMONSTRATION — not a valid record")
JOB_NUMBER = Words("任务编号", "Job No.")
STARTED = Words("开始时间", "Started")
FINISHED = Words("结束时间", "Finished")
RAW_RATES = Words("标度因数记录（7.1），{axis} 轴", "Scale factor as recorded (7.1), {axis} axis")
RAW_ORDER = Words("序号", "No.")
RAW_SEGMENT = Words("记录段", "Segment")
RAW_DEMANDED = Words("指令速率", "Demanded rate")
RAW_USED = Words("输入速率 Ω_{j}", "Input rate Ω_{j}")
RAW_MEAN = Words("平均值", "Mean")
RAW_OUTPUT = Words("输出 F_{j}", "Output F_{j}")
RAW_RESIDUAL = Words("残差 v_{j}", "Residual v_{j}")
STATICS = Words(
    "静止输出平均值：F_{{s}} = {before} {output}，F_{{e}} = {after} {output}，F_{{r}} = {mean} {output}；"
    "拟合：K = {K} {unit}，F_{{0}} = {F0} {output}。",
    "At rest: F_{{s}} = {before} {output}, F_{{e}} = {after} {output}, F_{{r}} = {mean} {output}; fit: "
    "K = {K} {unit}, F_{{0}} = {F0} {output}.",
)
TABLE_2 = Words("表 2  {axis} 轴零偏校准结果记录", "Table 2: zero offset, {axis} axis")
MULTI_POSITION = Words("{axis} 轴零偏多位置法记录（7.2.2）", "Zero offset by positions (7.2.2), {axis} axis")
POSITION = Words("位置", "Position")
POINTING = Words("{axis} 轴朝向", "{axis} points")
AZIMUTH = Words("转台方位", "Azimuth")
RAW_ANGLE = Words("{axis} 轴输出 N_{{{index}}}", "Output N_{{{index}}}")
RAW_DWELL = Words("时间 T", "Duration T")
OFFSET_LINE = Words("零偏 B_{{{axis}}} = {value} °/s", "Zero offset B_{{{axis}}} = {value} °/s")
TABLE_3 = Words("表 3  {axis} 轴失准角校准结果记录", "Table 3: misalignment, {axis} axis turned")
TURNED = Words("旋转轴向", "Turned")
TURN_RATE = Words("旋转角速率", "Rate")
TURN_COUNT = Words("周数 n", "Turns n")
CROSS_OUTPUT = Words("{axis} 轴输出角度值 N_{{{index}}}", "Output angle, {axis} axis, N_{{{index}}}")
ORIENTATION_WORDS = {
    "E": Words("东", "east"),
    "W": Words("西", "west"),
    "N": Words("北", "north"),
    "S": Words("南", "south"),
    "U": Words("天", "up"),
    "D": Words("地", "down"),
}
FULL_RESULTS = Words("计算结果（未修约）", "Results, not rounded")
STANDARD_UNCERTAINTY = Words("标准不确定度 u_{c}", "Standard uncertainty u_{c}")
DOF = Words("自由度 ν", "Degrees of freedom ν")
ORDER_RUN = Words("记录次序", "Order of recording")
REPEATED = Words("重复、弃用或中断的记录段", "Segments repeated, set aside or interrupted")
NONE_REPEATED = Words("结果中未列出。", "None is listed in the result.")
WARNINGS = Words("警告", "Warnings")
DIAGNOSIS = Words("数据诊断", "What the data say about themselves")
DIAGNOSIS_NOTE = Words(
    "p：数据正常时出现同样或更大差异的概率；小于 0.01 标为留意，小于 0.001 列为警告。诊断不剔除任何记录。",
    "p: the chance of so large a difference in good data; below 0.01 it is worth a look, below 0.001 a "
    "warning. The diagnosis leaves no recording out.",
)
FINDING_STATES = {
    "fine": Words("正常", "fine"),
    "look": Words("留意", "look"),
    "warn": Words("警告", "warning"),
}
FINDING_STATE = Words("状态", "State")
FINDING_P = Words("p", "p")
PLAN = Words("校准方案设置", "Settings of the plan")
SETTING = Words("设置", "Setting")
SETTING_VALUE = Words("值", "Value")
REASON = Words("原因", "Reason")
LINE = Words("行", "Line")
WHAT = Words("内容", "What")
MISALIGNMENT_CHART = Words("失准角", "Misalignment")
MISALIGNMENT_Y = Words("L / ′", "L / ′")
MISALIGNMENT_X = Words("输出轴", "output axis")
MISALIGNMENT_NOTE = Words(
    "误差线：± U；各图为一个转动轴。", "Error bars: ± U; one panel for each turned axis."
)
