<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="zh_CN">
<context>
    <name>AhrsView</name>
    <message>
        <source>The stream is paused, the settings of the bench file are set and read back; what differs is shown.</source>
        <translation>暂停数据流，写入台架文件中的设置并回读；显示不一致的项目。</translation>
    </message>
    <message>
        <source>The device has taken every setting.</source>
        <translation>设备已接受全部设置。</translation>
    </message>
    <message>
        <source>Shows how soon a pulled data cable is noticed and the stream is back.</source>
        <translation>检验拔出数据线多久被发现、数据流多久恢复。</translation>
    </message>
    <message>
        <source>Pull the device&apos;s data cable now.</source>
        <translation>请现在拔出设备的数据线。</translation>
    </message>
    <message>
        <source>The loss was noticed. Plug the cable in again.</source>
        <translation>已发现断线。请重新插上数据线。</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>取消</translation>
    </message>
    <message>
        <source>Begin the test</source>
        <translation>开始检验</translation>
    </message>
    <message>
        <source>Readings, mean of one second</source>
        <translation>读数（1 s 平均）</translation>
    </message>
    <message>
        <source>Rate</source>
        <translation>角速率</translation>
    </message>
    <message>
        <source>Specific force</source>
        <translation>比力</translation>
    </message>
    <message>
        <source>Heading, pitch, roll</source>
        <translation>航向、俯仰、横滚</translation>
    </message>
    <message>
        <source>The line</source>
        <translation>数据线路</translation>
    </message>
    <message>
        <source>Samples</source>
        <translation>样本数</translation>
    </message>
    <message>
        <source>Sample rate</source>
        <translation>采样率</translation>
    </message>
    <message>
        <source>Bits per second</source>
        <translation>比特率</translation>
    </message>
    <message>
        <source>Host − device time</source>
        <translation>主机 − 设备时间</translation>
    </message>
    <message>
        <source>Clock rate</source>
        <translation>时钟速率差</translation>
    </message>
    <message>
        <source>Late by (95 %)</source>
        <translation>延迟（95 %）</translation>
    </message>
    <message>
        <source>Temperature</source>
        <translation>温度</translation>
    </message>
    <message>
        <source>Settings of the device</source>
        <translation>设备设置</translation>
    </message>
    <message>
        <source>Configure and read back</source>
        <translation>配置并回读</translation>
    </message>
    <message>
        <source>Unplugging</source>
        <translation>断线检验</translation>
    </message>
</context>
<context>
    <name>AnalysisPage</name>
    <message>
        <source>Analyses of recordings</source>
        <translation>记录数据分析</translation>
    </message>
    <message>
        <source>Allan deviation, navigation, alignment and calibration of inertial units from recorded data will be here, with their tables and charts.</source>
        <translation>这里将显示由记录数据进行的阿伦偏差、导航、对准和惯性测量单元标定等分析及其图表。</translation>
    </message>
</context>
<context>
    <name>AnalysisSettings</name>
    <message>
        <source>A number, please.</source>
        <translation>请输入数值。</translation>
    </message>
    <message>
        <source>From {low} to {high}.</source>
        <translation>应在 {low} 至 {high} 之间。</translation>
    </message>
    <message>
        <source>At least {low}.</source>
        <translation>不应小于 {low}。</translation>
    </message>
    <message>
        <source>At most {high}.</source>
        <translation>不应大于 {high}。</translation>
    </message>
</context>
<context>
    <name>BeforeRunCard</name>
    <message>
        <source>of bench time; mountings: {count}</source>
        <translation>台架时间；装夹 {count} 次</translation>
    </message>
    <message>
        <source>A limit is not right: see the tab Limits.</source>
        <translation>有一项限值不正确：请看“限值”页。</translation>
    </message>
    <message>
        <source>The plan cannot be run as it stands: see the tab Plan.</source>
        <translation>方案目前无法执行：请看“方案”页。</translation>
    </message>
    <message>
        <source>Customer, device and people are entered.</source>
        <translation>送校单位、被校对象和人员已填写。</translation>
    </message>
    <message>
        <source>The standards satisfy clause 6.</source>
        <translation>计量标准器符合第 6 章要求。</translation>
    </message>
    <message>
        <source>The plan can be run; what leaves the standard goes into the record and the certificate.</source>
        <translation>方案可以执行；偏离规范之处记入原始记录和证书。</translation>
    </message>
    <message>
        <source>The plan follows JJF 1536-2015.</source>
        <translation>方案符合 JJF 1536-2015。</translation>
    </message>
    <message>
        <source>The plan can be run.</source>
        <translation>方案可以执行。</translation>
    </message>
    <message>
        <source>No conformity is stated: the limits are of quantities of JJF 1536-2015.</source>
        <translation>不作符合性判定：所设限值属于 JJF 1536-2015 的量。</translation>
    </message>
    <message>
        <source>Enter the customer.</source>
        <translation>请填写送校单位。</translation>
    </message>
    <message>
        <source>Enter the device&apos;s name or model.</source>
        <translation>请填写被校对象的名称或型号。</translation>
    </message>
    <message>
        <source>Choose the standards used.</source>
        <translation>请选择所用计量标准器。</translation>
    </message>
    <message>
        <source>Choose the operator.</source>
        <translation>请选择校准员。</translation>
    </message>
    <message>
        <source>Choose the verifier.</source>
        <translation>请选择核验员。</translation>
    </message>
    <message>
        <source>Choose the approver.</source>
        <translation>请选择签发人。</translation>
    </message>
    <message>
        <source>Choose the bench.</source>
        <translation>请选择台架。</translation>
    </message>
    <message>
        <source>Before the run</source>
        <translation>运行之前</translation>
    </message>
    <message>
        <source>This plan takes</source>
        <translation>本方案需要</translation>
    </message>
</context>
<context>
    <name>BenchForm</name>
    <message>
        <source>its own settings</source>
        <translation>自有设置</translation>
    </message>
    <message>
        <source>Bench</source>
        <translation>台架</translation>
    </message>
    <message>
        <source>Settings of the bench (TOML)</source>
        <translation>台架设置（TOML）</translation>
    </message>
    <message>
        <source>Rate table</source>
        <translation>速率转台</translation>
    </message>
    <message>
        <source>Highest rate</source>
        <translation>最大速率</translation>
    </message>
    <message>
        <source>Highest acceleration</source>
        <translation>最大角加速度</translation>
    </message>
    <message>
        <source>Device</source>
        <translation>被校对象</translation>
    </message>
    <message>
        <source>Supply</source>
        <translation>电源</translation>
    </message>
</context>
<context>
    <name>BenchPage</name>
    <message>
        <source>Bench</source>
        <translation>台架</translation>
    </message>
    <message>
        <source>of job {number}</source>
        <translation>任务 {number} 的台架</translation>
    </message>
    <message>
        <source>a preset to look at</source>
        <translation>供查看的预设</translation>
    </message>
    <message>
        <source>settings of the job</source>
        <translation>任务的设置</translation>
    </message>
    <message>
        <source>simulated</source>
        <translation>仿真</translation>
    </message>
    <message>
        <source>instruments</source>
        <translation>仪器</translation>
    </message>
    <message>
        <source>Setting</source>
        <translation>设置项</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>值</translation>
    </message>
    <message>
        <source>not connected</source>
        <translation>未连接</translation>
    </message>
    <message>
        <source>within clause 6</source>
        <translation>符合第 6 章</translation>
    </message>
    <message>
        <source>outside clause 6</source>
        <translation>超出第 6 章</translation>
    </message>
    <message>
        <source>What is ticked goes wrong during this job&apos;s run, from its start.</source>
        <translation>勾选的故障从本任务运行一开始就出现。</translation>
    </message>
    <message>
        <source>Open a job that is not measured yet to try faults in its run.</source>
        <translation>打开一个尚未测量的任务，即可在其运行中试验故障。</translation>
    </message>
    <message>
        <source>No bench yet</source>
        <translation>尚无台架</translation>
    </message>
    <message>
        <source>The instruments of the open job&apos;s bench will be here, with what they may do.</source>
        <translation>这里将列出所打开任务的台架仪器及其能力。</translation>
    </message>
    <message>
        <source>Choose a job</source>
        <translation>选择任务</translation>
    </message>
    <message>
        <source>Preset</source>
        <translation>预设</translation>
    </message>
    <message>
        <source>Instruments</source>
        <translation>仪器</translation>
    </message>
    <message>
        <source>Table limits and site</source>
        <translation>转台极限与场地</translation>
    </message>
    <message>
        <source>Room</source>
        <translation>环境</translation>
    </message>
    <message>
        <source>Faults to try</source>
        <translation>可试验的故障</translation>
    </message>
    <message>
        <source>Settings of the simulation</source>
        <translation>仿真设置</translation>
    </message>
    <message>
        <source>Rate table</source>
        <translation>速率转台</translation>
    </message>
    <message>
        <source>Device</source>
        <translation>被校对象</translation>
    </message>
    <message>
        <source>Supply</source>
        <translation>电源</translation>
    </message>
    <message>
        <source>Data stream</source>
        <translation>数据流</translation>
    </message>
    <message>
        <source>Highest rate</source>
        <translation>最大速率</translation>
    </message>
    <message>
        <source>Highest acceleration</source>
        <translation>最大角加速度</translation>
    </message>
    <message>
        <source>North at table angle</source>
        <translation>指北时转台角度</translation>
    </message>
    <message>
        <source>Latitude, altitude</source>
        <translation>纬度、海拔</translation>
    </message>
    <message>
        <source>Temperature</source>
        <translation>温度</translation>
    </message>
    <message>
        <source>Humidity</source>
        <translation>湿度</translation>
    </message>
</context>
<context>
    <name>BudgetTable</name>
    <message>
        <source>Source</source>
        <translation>来源</translation>
    </message>
    <message>
        <source>Type, distribution</source>
        <translation>类别，分布</translation>
    </message>
    <message>
        <source>From</source>
        <translation>依据</translation>
    </message>
    <message>
        <source>Share of variance</source>
        <translation>方差占比</translation>
    </message>
    <message>
        <source>normal</source>
        <translation>正态</translation>
    </message>
    <message>
        <source>rectangular</source>
        <translation>矩形</translation>
    </message>
    <message>
        <source>triangular</source>
        <translation>三角</translation>
    </message>
    <message>
        <source>arcsine</source>
        <translation>反正弦</translation>
    </message>
    <message>
        <source>Student&apos;s t</source>
        <translation>t 分布</translation>
    </message>
    <message>
        <source>the recording</source>
        <translation>记录数据</translation>
    </message>
    <message>
        <source>certificate {number}</source>
        <translation>证书 {number}</translation>
    </message>
    <message>
        <source>a certificate</source>
        <translation>证书</translation>
    </message>
    <message>
        <source>an assumption</source>
        <translation>假定</translation>
    </message>
</context>
<context>
    <name>BudgetView</name>
    <message>
        <source>annex A</source>
        <translation>附录 A</translation>
    </message>
    <message>
        <source>GUM</source>
        <translation>GUM</translation>
    </message>
    <message>
        <source>U from Monte Carlo</source>
        <translation>U 取自蒙特卡洛法</translation>
    </message>
    <message>
        <source>reported: U = {expanded} (CMC)</source>
        <translation>报告值：U = {expanded}（CMC）</translation>
    </message>
    <message>
        <source>What if …</source>
        <translation>假如…</translation>
    </message>
    <message>
        <source>Type another u(x) and see U: double-click a row, or F2. The result stays as it is.</source>
        <translation>输入另一个 u(x) 看 U 如何变化：双击一行，或按 F2。结果保持不变。</translation>
    </message>
    <message>
        <source>Save as CSV …</source>
        <translation>另存为 CSV…</translation>
    </message>
    <message>
        <source>All budgets of this result, for a spreadsheet.</source>
        <translation>本结果的全部不确定度预算，可用电子表格打开。</translation>
    </message>
    <message>
        <source>Monte Carlo</source>
        <translation>蒙特卡洛</translation>
    </message>
    <message>
        <source>Show or hide the Monte Carlo check.</source>
        <translation>显示或隐藏蒙特卡洛检查。</translation>
    </message>
</context>
<context>
    <name>CaseDrawing</name>
    <message>
        <source>N</source>
        <translation>北</translation>
    </message>
    <message>
        <source>E</source>
        <translation>东</translation>
    </message>
    <message>
        <source>up</source>
        <translation>天</translation>
    </message>
</context>
<context>
    <name>CertificatePage</name>
    <message>
        <source>Save as</source>
        <translation>另存为</translation>
    </message>
    <message>
        <source>PDF files (*.pdf)</source>
        <translation>PDF 文件 (*.pdf)</translation>
    </message>
    <message>
        <source>Saved as {path}.</source>
        <translation>已保存为 {path}。</translation>
    </message>
    <message>
        <source>page {page} of {count}</source>
        <translation>第 {page} 页，共 {count} 页</translation>
    </message>
    <message>
        <source>No certificate yet</source>
        <translation>尚无证书</translation>
    </message>
    <message>
        <source>After the calibration is measured, its certificate will be here to look at and to sign.</source>
        <translation>校准测量完成后，证书将在这里供查看和签名。</translation>
    </message>
    <message>
        <source>Go to the job</source>
        <translation>转到任务</translation>
    </message>
    <message>
        <source>No job is open</source>
        <translation>没有打开的任务</translation>
    </message>
    <message>
        <source>Open a measured job to look at its certificate and to sign it.</source>
        <translation>打开一个已测量的任务，即可查看其证书并签名。</translation>
    </message>
    <message>
        <source>Choose a job</source>
        <translation>选择任务</translation>
    </message>
    <message>
        <source>Bilingual</source>
        <translation>中英双语</translation>
    </message>
    <message>
        <source>Uncertainty budgets</source>
        <translation>附不确定度评定表</translation>
    </message>
    <message>
        <source>With the uncertainty budgets as annex pages</source>
        <translation>附不确定度评定页</translation>
    </message>
    <message>
        <source>Smaller</source>
        <translation>缩小</translation>
    </message>
    <message>
        <source>Larger</source>
        <translation>放大</translation>
    </message>
    <message>
        <source>Signatures</source>
        <translation>签名</translation>
    </message>
    <message>
        <source>Files</source>
        <translation>文件</translation>
    </message>
    <message>
        <source>Send back for a new certificate …</source>
        <translation>退回以重新出具证书…</translation>
    </message>
    <message>
        <source>Save the certificate as …</source>
        <translation>证书另存为…</translation>
    </message>
    <message>
        <source>Save the original record as …</source>
        <translation>原始记录另存为…</translation>
    </message>
</context>
<context>
    <name>ContextBar</name>
    <message>
        <source>Job {number}</source>
        <translation>任务 {number}</translation>
    </message>
    <message>
        <source>No job open</source>
        <translation>没有打开的任务</translation>
    </message>
    <message>
        <source>s/n {number}</source>
        <translation>出厂编号 {number}</translation>
    </message>
    <message>
        <source>Simulated bench</source>
        <translation>仿真台架</translation>
    </message>
    <message>
        <source>Light or dark</source>
        <translation>浅色或深色</translation>
    </message>
    <message>
        <source>Light</source>
        <translation>浅色</translation>
    </message>
    <message>
        <source>Dark</source>
        <translation>深色</translation>
    </message>
    <message>
        <source>As the system</source>
        <translation>跟随系统</translation>
    </message>
    <message>
        <source>Nobody signed in</source>
        <translation>无人登录</translation>
    </message>
</context>
<context>
    <name>Desk</name>
    <message>
        <source>A run is going on: stop it or wait for its end.</source>
        <translation>正在运行：请先停止或等待其结束。</translation>
    </message>
</context>
<context>
    <name>DiagnosisView</name>
    <message>
        <source>fine</source>
        <translation>正常</translation>
    </message>
    <message>
        <source>worth a look</source>
        <translation>值得查看</translation>
    </message>
    <message>
        <source>warning</source>
        <translation>警告</translation>
    </message>
    <message>
        <source>{symbol}: residuals</source>
        <translation>{symbol}：残差</translation>
    </message>
    <message>
        <source>bars: two standard errors; ringed: stands apart</source>
        <translation>误差棒：两倍标准误差；带圈：离群点</translation>
    </message>
    <message>
        <source>{symbol}: both senses</source>
        <translation>{symbol}：正反两个方向</translation>
    </message>
    <message>
        <source>{symbol}: Allan deviation</source>
        <translation>{symbol}：阿伦偏差</translation>
    </message>
    <message>
        <source>band: 95 %; line: the noise model of the budget</source>
        <translation>色带：95 %；曲线：不确定度评定所用噪声模型</translation>
    </message>
    <message>
        <source>{symbol}: the Earth&apos;s rate</source>
        <translation>{symbol}：地球自转</translation>
    </message>
    <message>
        <source>line: as measured; dashed: expected at this latitude</source>
        <translation>实线：实测；虚线：当地纬度的预期值</translation>
    </message>
    <message>
        <source>{symbol}: single recordings</source>
        <translation>{symbol}：各段记录</translation>
    </message>
    <message>
        <source>Earth&apos;s rate taken out; bars: two standard errors of noise</source>
        <translation>已扣除地球自转；误差棒：噪声的两倍标准误差</translation>
    </message>
    <message>
        <source>This result has no diagnosis: an earlier version made it. Calculate it again to see one.</source>
        <translation>此结果没有诊断：由较早的版本生成。请重新计算后查看。</translation>
    </message>
    <message>
        <source>Rate</source>
        <translation>速率</translation>
    </message>
    <message>
        <source>Order</source>
        <translation>顺序</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>时间</translation>
    </message>
    <message>
        <source>Allan deviation</source>
        <translation>阿伦偏差</translation>
    </message>
    <message>
        <source>Recordings</source>
        <translation>各段记录</translation>
    </message>
    <message>
        <source>Earth&apos;s rate</source>
        <translation>地球自转</translation>
    </message>
</context>
<context>
    <name>EndView</name>
    <message>
        <source>The run is complete</source>
        <translation>校准运行完成</translation>
    </message>
    <message>
        <source>The table rests, the supply is off.</source>
        <translation>转台已静止，电源已断开。</translation>
    </message>
    <message>
        <source>The table rests, the supply is off. What was recorded is kept.</source>
        <translation>转台已静止，电源已断开。已记录的数据均已保留。</translation>
    </message>
    <message>
        <source>The run was stopped</source>
        <translation>运行已停止</translation>
    </message>
    <message>
        <source>The bench was brought to rest. What was recorded is kept.</source>
        <translation>台架已恢复静止。已记录的数据均已保留。</translation>
    </message>
    <message>
        <source>The run could not go on</source>
        <translation>运行无法继续</translation>
    </message>
    <message>
        <source>and {n} more, in the result</source>
        <translation>另有 {n} 条，见结果</translation>
    </message>
    <message>
        <source>Show the results</source>
        <translation>查看结果</translation>
    </message>
    <message>
        <source>Resume the run</source>
        <translation>继续运行</translation>
    </message>
    <message>
        <source>What was recorded is kept.</source>
        <translation>已记录的数据已保存。</translation>
    </message>
    <message>
        <source>Segments recorded in this run</source>
        <translation>本次运行记录的数据段</translation>
    </message>
    <message>
        <source>Samples lost</source>
        <translation>丢失样本</translation>
    </message>
    <message>
        <source>Warnings</source>
        <translation>警告</translation>
    </message>
    <message>
        <source>Repeat a segment …</source>
        <translation>重测某一数据段…</translation>
    </message>
</context>
<context>
    <name>FaultKeeper</name>
    <message>
        <source>That did not work</source>
        <translation>操作未成功</translation>
    </message>
    <message>
        <source>A fault of the application</source>
        <translation>程序故障</translation>
    </message>
    <message>
        <source>Something went wrong that should not. A run that is going on is not touched by it, and what is recorded is on disk.</source>
        <translation>程序出现了不应有的错误。正在进行的运行不受影响，已记录的数据均在磁盘上。</translation>
    </message>
    <message>
        <source>The details are in the log; please pass them on.</source>
        <translation>详情已写入日志，请转交开发者。</translation>
    </message>
</context>
<context>
    <name>FeelsPanel</name>
    <message>
        <source>The sensor feels</source>
        <translation>传感器感受到</translation>
    </message>
    <message>
        <source>It is asked after you say so.</source>
        <translation>您确认后即查询传感器。</translation>
    </message>
    <message>
        <source>Power is off. It is asked when power is back.</source>
        <translation>电源已断开。恢复供电后查询传感器。</translation>
    </message>
    <message>
        <source>{tilt}° off level, still</source>
        <translation>水平偏差 {tilt}°，静止</translation>
    </message>
</context>
<context>
    <name>FiguresForm</name>
    <message>
        <source>{figure}: write numbers as 10, 0.0002 or 2E-4.</source>
        <translation>{figure}：请按 10、0.0002 或 2E-4 的形式填写数值。</translation>
    </message>
    <message>
        <source>Figures that the certificate states</source>
        <translation>证书给出的数据</translation>
    </message>
    <message>
        <source>They go into the uncertainty budgets or the check of clause 6; what a budget lacks is clause 6&apos;s own figure, marked as an assumption.</source>
        <translation>用于测量不确定度评定或规范第 6 章条件的检查；不确定度评定所缺的项采用第 6 章的数值，并标为假定值。</translation>
    </message>
    <message>
        <source>Figure</source>
        <translation>数据</translation>
    </message>
    <message>
        <source>U or limit</source>
        <translation>U 或极限</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>单位</translation>
    </message>
    <message>
        <source>Stated as</source>
        <translation>给出方式</translation>
    </message>
    <message>
        <source>Degrees of freedom, where the certificate states them</source>
        <translation>自由度（证书给出时填写）</translation>
    </message>
    <message>
        <source>U with k</source>
        <translation>U 和 k</translation>
    </message>
    <message>
        <source>± limit, rectangular</source>
        <translation>± 极限，矩形分布</translation>
    </message>
    <message>
        <source>± limit, triangular</source>
        <translation>± 极限，三角分布</translation>
    </message>
    <message>
        <source>± limit, arcsine</source>
        <translation>± 极限，反正弦分布</translation>
    </message>
</context>
<context>
    <name>FindingsView</name>
    <message>
        <source>Warnings</source>
        <translation>警告</translation>
    </message>
    <message>
        <source>The recording has no defects.</source>
        <translation>记录没有缺陷。</translation>
    </message>
    <message>
        <source>Deviations from the standard</source>
        <translation>与规范的偏离</translation>
    </message>
    <message>
        <source>Remarks on the method</source>
        <translation>方法说明</translation>
    </message>
    <message>
        <source>The plan follows JJF 1536-2015.</source>
        <translation>方案符合 JJF 1536-2015。</translation>
    </message>
    <message>
        <source>None.</source>
        <translation>无。</translation>
    </message>
    <message>
        <source>Expanded uncertainty</source>
        <translation>扩展不确定度</translation>
    </message>
    <message>
        <source>U of {quantities} is raised to the laboratory&apos;s best measurement capability (CMC).</source>
        <translation>{quantities} 的 U 已提高到实验室的最佳测量能力（CMC）。</translation>
    </message>
    <message>
        <source>Room during the run</source>
        <translation>运行期间的环境</translation>
    </message>
    <message>
        <source>({t} ± {dt}) °C, ({h} ± {dh}) %RH</source>
        <translation>({t} ± {dt}) °C，({h} ± {dh}) %RH</translation>
    </message>
    <message>
        <source>{text} (segment {segment}, line {line})</source>
        <translation>{text}（数据段 {segment}，第 {line} 行）</translation>
    </message>
    <message>
        <source>{text} (segment {segment})</source>
        <translation>{text}（数据段 {segment}）</translation>
    </message>
</context>
<context>
    <name>HandView</name>
    <message>
        <source>Being checked …</source>
        <translation>正在核对 …</translation>
    </message>
    <message>
        <source>Space</source>
        <translation>空格</translation>
    </message>
    <message>
        <source>The device has felt</source>
        <translation>航姿仪测得转过</translation>
    </message>
    <message>
        <source>The device feels</source>
        <translation>航姿仪测得</translation>
    </message>
    <message>
        <source>as asked, within {allowed}</source>
        <translation>符合要求，{allowed} 以内</translation>
    </message>
    <message>
        <source>turning, {rate} °/s</source>
        <translation>正在转动，{rate} °/s</translation>
    </message>
    <message>
        <source>not yet within {allowed}</source>
        <translation>尚未进入 {allowed}</translation>
    </message>
    <message>
        <source>The device feels nothing of it now, so your word is taken: look twice before confirming.</source>
        <translation>航姿仪目前无法测得转台的状态，以您的确认为准：请看清后再确认。</translation>
    </message>
</context>
<context>
    <name>HandWords</name>
    <message>
        <source>Switch the rate table on</source>
        <translation>接通转台电源</translation>
    </message>
    <message>
        <source>Set the rate by hand</source>
        <translation>手动设置转速</translation>
    </message>
    <message>
        <source>Turn the table to an angle</source>
        <translation>将转台转到指定角度</translation>
    </message>
    <message>
        <source>Turn the table by whole turns</source>
        <translation>将转台转过整圈数</translation>
    </message>
    <message>
        <source>Bring the table to rest</source>
        <translation>使转台停止</translation>
    </message>
    <message>
        <source>Switch the rate table off</source>
        <translation>关闭转台</translation>
    </message>
    <message>
        <source>Clockwise seen from above. Confirm when it turns steadily.</source>
        <translation>俯视顺时针。转动平稳后确认。</translation>
    </message>
    <message>
        <source>Anticlockwise seen from above. Confirm when it turns steadily.</source>
        <translation>俯视逆时针。转动平稳后确认。</translation>
    </message>
    <message>
        <source>Clockwise seen from above, at most {rate} °/s, to rest where it began. It is being recorded.</source>
        <translation>俯视顺时针，不超过 {rate} °/s，回到起始位置停止。正在记录。</translation>
    </message>
    <message>
        <source>Anticlockwise seen from above, at most {rate} °/s, to rest where it began. It is being recorded.</source>
        <translation>俯视逆时针，不超过 {rate} °/s，回到起始位置停止。正在记录。</translation>
    </message>
    <message>
        <source>Let it stand still at its zero mark.</source>
        <translation>使转台静止在零位标记处。</translation>
    </message>
    <message>
        <source>On the table&apos;s own scale, counted anticlockwise seen from above. Let it stand still.</source>
        <translation>以转台自身刻度为准，俯视逆时针计数。使其静止。</translation>
    </message>
    <message>
        <source>Confirm when it stands still.</source>
        <translation>静止后确认。</translation>
    </message>
    <message>
        <source>Bring it to rest first.</source>
        <translation>请先使其停止。</translation>
    </message>
    <message>
        <source>turns</source>
        <translation>圈</translation>
    </message>
    <message>
        <source>on the table&apos;s scale</source>
        <translation>转台刻度</translation>
    </message>
    <message>
        <source>It is on and stands</source>
        <translation>已接通并静止</translation>
    </message>
    <message>
        <source>It turns steadily</source>
        <translation>转动已平稳</translation>
    </message>
    <message>
        <source>It stands there</source>
        <translation>已静止在该处</translation>
    </message>
    <message>
        <source>Turned, at rest</source>
        <translation>已转完并静止</translation>
    </message>
    <message>
        <source>It stands still</source>
        <translation>已静止</translation>
    </message>
    <message>
        <source>It is off</source>
        <translation>已关闭</translation>
    </message>
</context>
<context>
    <name>HealthStrip</name>
    <message>
        <source>The bench is watched while a run is going on.</source>
        <translation>运行期间监视台架。</translation>
    </message>
    <message>
        <source>segments on disk: {n}</source>
        <translation>已存数据段：{n}</translation>
    </message>
    <message>
        <source>table: {fault}</source>
        <translation>转台：{fault}</translation>
    </message>
    <message>
        <source>table disabled</source>
        <translation>转台未使能</translation>
    </message>
    <message>
        <source>table turning</source>
        <translation>转台转动中</translation>
    </message>
    <message>
        <source>table ready</source>
        <translation>转台就绪</translation>
    </message>
    <message>
        <source>AHRS without power</source>
        <translation>航姿仪未供电</translation>
    </message>
    <message>
        <source>AHRS {rate} Hz</source>
        <translation>航姿仪 {rate} Hz</translation>
    </message>
    <message>
        <source>{rate}, {n} samples lost</source>
        <translation>{rate}，丢失 {n}</translation>
    </message>
    <message>
        <source>{rate}, 0 lost</source>
        <translation>{rate}，丢失 0</translation>
    </message>
    <message>
        <source>supply off</source>
        <translation>电源断开</translation>
    </message>
    <message>
        <source>supply {voltage} V  {current} A</source>
        <translation>电源 {voltage} V  {current} A</translation>
    </message>
    <message>
        <source>{room}: outside clause 6</source>
        <translation>{room}：超出第 6 章</translation>
    </message>
</context>
<context>
    <name>ImuView</name>
    <message>
        <source>Calibrated from {count} positions</source>
        <translation>由 {count} 个位置标定</translation>
    </message>
    <message>
        <source>Each value with its U (k = 2). Warnings: {warnings}.</source>
        <translation>各值附 U（k = 2）。警告：{warnings} 条。</translation>
    </message>
    <message>
        <source>To the certificate</source>
        <translation>查看证书</translation>
    </message>
    <message>
        <source>Quantity</source>
        <translation>参数</translation>
    </message>
    <message>
        <source>Output channel</source>
        <translation>输出通道</translation>
    </message>
    <message>
        <source>Input axis {axis}</source>
        <translation>输入轴 {axis}</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>单位</translation>
    </message>
    <message>
        <source>Position</source>
        <translation>位置</translation>
    </message>
    <message>
        <source>X, Y, Z point</source>
        <translation>X、Y、Z 指向</translation>
    </message>
    <message>
        <source>Gyro {axis}, °/h</source>
        <translation>陀螺 {axis}，°/h</translation>
    </message>
    <message>
        <source>Accel. {axis}, mm/s²</source>
        <translation>加速度计 {axis}，mm/s²</translation>
    </message>
    <message>
        <source>Residuals of the fit. Condition numbers: positions {positions}, turns {turns}.</source>
        <translation>拟合残差。条件数：位置 {positions}，转动 {turns}。</translation>
    </message>
    <message>
        <source>Scale factor E1</source>
        <translation>标度因数 E1</translation>
    </message>
    <message>
        <source>Zero offset (constant drift) B0</source>
        <translation>零偏（常值漂移）B0</translation>
    </message>
    <message>
        <source>Specific-force coefficients Bf</source>
        <translation>视加速度影响系数 Bf</translation>
    </message>
    <message>
        <source>Misalignment E</source>
        <translation>失准角 E</translation>
    </message>
    <message>
        <source>Scale factor K1</source>
        <translation>标度因数 K1</translation>
    </message>
    <message>
        <source>Zero offset K0</source>
        <translation>零偏 K0</translation>
    </message>
    <message>
        <source>Misalignment K</source>
        <translation>失准角 K</translation>
    </message>
    <message>
        <source>Gyros</source>
        <translation>陀螺</translation>
    </message>
    <message>
        <source>Accelerometers</source>
        <translation>加速度计</translation>
    </message>
    <message>
        <source>Positions and residuals</source>
        <translation>位置与残差</translation>
    </message>
    <message>
        <source>Warnings and remarks</source>
        <translation>警告与说明</translation>
    </message>
    <message>
        <source>N = E1·[B0 + Bf·f + (I + E)·ω], N_A = K1·[K0 + (I + K)·f], channel by channel. To compensate: f = inv(I + K)·(N_A/K1 − K0), then ω = inv(I + E)·(N/E1 − B0 − Bf·f).</source>
        <translation>N = E1·[B0 + Bf·f + (I + E)·ω]，N_A = K1·[K0 + (I + K)·f]，逐通道相乘。补偿：先 f = inv(I + K)·(N_A/K1 − K0)，再 ω = inv(I + E)·(N/E1 − B0 − Bf·f)。</translation>
    </message>
</context>
<context>
    <name>InstrumentDialog</name>
    <message>
        <source>Language to begin with</source>
        <translation>初始指令集</translation>
    </message>
    <message>
        <source>Remove from the bench</source>
        <translation>从台架移除</translation>
    </message>
    <message>
        <source>Driver</source>
        <translation>驱动程序</translation>
    </message>
    <message>
        <source>Settings that are left empty have the driver&apos;s own default, shown in grey.</source>
        <translation>留空的设置采用驱动程序的默认值（灰色显示）。</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>保存</translation>
    </message>
    <message>
        <source>Fewer settings</source>
        <translation>较少设置</translation>
    </message>
    <message>
        <source>All settings</source>
        <translation>全部设置</translation>
    </message>
    <message>
        <source>yes</source>
        <translation>是</translation>
    </message>
    <message>
        <source>no</source>
        <translation>否</translation>
    </message>
    <message>
        <source>no end</source>
        <translation>无限制</translation>
    </message>
</context>
<context>
    <name>InstrumentWords</name>
    <message>
        <source>Rate table</source>
        <translation>速率转台</translation>
    </message>
    <message>
        <source>AHRS</source>
        <translation>航姿仪</translation>
    </message>
    <message>
        <source>Power supply</source>
        <translation>直流电源</translation>
    </message>
    <message>
        <source>Room sensor</source>
        <translation>温湿度计</translation>
    </message>
    <message>
        <source>not connected</source>
        <translation>未连接</translation>
    </message>
    <message>
        <source>connecting …</source>
        <translation>正在连接…</translation>
    </message>
    <message>
        <source>connected</source>
        <translation>已连接</translation>
    </message>
    <message>
        <source>link lost</source>
        <translation>连接中断</translation>
    </message>
    <message>
        <source>fault</source>
        <translation>故障</translation>
    </message>
    <message>
        <source>Serial port</source>
        <translation>串口</translation>
    </message>
    <message>
        <source>Baud rate</source>
        <translation>波特率</translation>
    </message>
    <message>
        <source>Network address</source>
        <translation>网络地址</translation>
    </message>
    <message>
        <source>TCP port</source>
        <translation>TCP 端口</translation>
    </message>
    <message>
        <source>Highest rate, °/s</source>
        <translation>最大角速率，°/s</translation>
    </message>
    <message>
        <source>Highest acceleration, °/s²</source>
        <translation>最大角加速度，°/s²</translation>
    </message>
    <message>
        <source>Smallest angle, °</source>
        <translation>最小角度，°</translation>
    </message>
    <message>
        <source>Largest angle, °</source>
        <translation>最大角度，°</translation>
    </message>
    <message>
        <source>Samples per second</source>
        <translation>每秒样本数</translation>
    </message>
    <message>
        <source>Range of the device, °/s</source>
        <translation>设备量程，°/s</translation>
    </message>
    <message>
        <source>Manufacturer</source>
        <translation>制造厂</translation>
    </message>
    <message>
        <source>Model</source>
        <translation>型号</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>出厂编号</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>名称</translation>
    </message>
    <message>
        <source>Axis number</source>
        <translation>轴号</translation>
    </message>
    <message>
        <source>Highest voltage, V</source>
        <translation>最高电压，V</translation>
    </message>
    <message>
        <source>Highest current, A</source>
        <translation>最大电流，A</translation>
    </message>
    <message>
        <source>Read every, s</source>
        <translation>读取间隔，s</translation>
    </message>
    <message>
        <source>Frames</source>
        <translation>帧数</translation>
    </message>
    <message>
        <source>Lost</source>
        <translation>丢失</translation>
    </message>
    <message>
        <source>Checksum wrong</source>
        <translation>校验错误</translation>
    </message>
    <message>
        <source>Bytes skipped</source>
        <translation>跳过字节</translation>
    </message>
    <message>
        <source>Repeated</source>
        <translation>重复</translation>
    </message>
    <message>
        <source>Implausible</source>
        <translation>不合理</translation>
    </message>
    <message>
        <source>Reconnected</source>
        <translation>重新连接</translation>
    </message>
    <message>
        <source>Connect</source>
        <translation>连接</translation>
    </message>
    <message>
        <source>Identify</source>
        <translation>识别</translation>
    </message>
    <message>
        <source>Query</source>
        <translation>查询</translation>
    </message>
    <message>
        <source>Drive on</source>
        <translation>上电使能</translation>
    </message>
    <message>
        <source>Turn at a rate</source>
        <translation>以速率转动</translation>
    </message>
    <message>
        <source>Go to an angle</source>
        <translation>转到角度</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>停止</translation>
    </message>
    <message>
        <source>Drive off</source>
        <translation>断开使能</translation>
    </message>
    <message>
        <source>Keep alive</source>
        <translation>保持连接</translation>
    </message>
</context>
<context>
    <name>InstrumentsPage</name>
    <message>
        <source>Instruments</source>
        <translation>仪器</translation>
    </message>
    <message>
        <source>The rate table&apos;s readings will be here, and buttons to move it by hand.</source>
        <translation>这里将显示转台的读数和手动控制按钮。</translation>
    </message>
    <message>
        <source>The device&apos;s rates, forces and angles will be here, and what its line loses.</source>
        <translation>这里将显示设备的角速率、比力和姿态角，以及线路丢失的数据。</translation>
    </message>
    <message>
        <source>Voltage and current of the device will be here, and its switch.</source>
        <translation>这里将显示设备的电压、电流和电源开关。</translation>
    </message>
    <message>
        <source>Temperature and humidity of the room will be here.</source>
        <translation>这里将显示室内温度和湿度。</translation>
    </message>
    <message>
        <source>None on this bench yet</source>
        <translation>此台架尚无该仪器</translation>
    </message>
    <message>
        <source>Add …</source>
        <translation>添加…</translation>
    </message>
    <message>
        <source>Connect, look, configure and move by hand; a run connects them by itself.</source>
        <translation>连接、查看、配置、手动控制；校准运行时会自动连接。</translation>
    </message>
    <message>
        <source>Bench of instruments</source>
        <translation>仪器台架</translation>
    </message>
    <message>
        <source>New bench</source>
        <translation>新建台架</translation>
    </message>
    <message>
        <source>Use for the open job</source>
        <translation>用于当前任务</translation>
    </message>
    <message>
        <source>Now</source>
        <translation>当前状态</translation>
    </message>
    <message>
        <source>Language</source>
        <translation>指令集</translation>
    </message>
    <message>
        <source>No bench of instruments yet</source>
        <translation>尚无仪器台架</translation>
    </message>
    <message>
        <source>The rate table, the device, the power supply and the room sensor will be here, each with its driver, its connection and what it reads.</source>
        <translation>这里将列出转台、设备、直流电源和温湿度计，以及各自的驱动程序、连接和读数。</translation>
    </message>
</context>
<context>
    <name>JobEditor</name>
    <message>
        <source>Job {number}</source>
        <translation>任务 {number}</translation>
    </message>
    <message>
        <source>New job</source>
        <translation>新建任务</translation>
    </message>
    <message>
        <source>Measure again</source>
        <translation>重新测量</translation>
    </message>
    <message>
        <source>Start calibration</source>
        <translation>开始校准</translation>
    </message>
    <message>
        <source>The job is not complete yet: see the list “Before the run” on its page.</source>
        <translation>任务尚不完整：请看其页面上的“运行之前”清单。</translation>
    </message>
    <message>
        <source>All jobs</source>
        <translation>全部任务</translation>
    </message>
    <message>
        <source>Order</source>
        <translation>委托</translation>
    </message>
    <message>
        <source>Standards</source>
        <translation>标准器</translation>
    </message>
    <message>
        <source>Plan</source>
        <translation>方案</translation>
    </message>
    <message>
        <source>Bench</source>
        <translation>台架</translation>
    </message>
    <message>
        <source>Limits</source>
        <translation>限值</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>保存</translation>
    </message>
</context>
<context>
    <name>JobsPage</name>
    <message>
        <source>Jobs</source>
        <translation>任务</translation>
    </message>
    <message>
        <source>Number</source>
        <translation>编号</translation>
    </message>
    <message>
        <source>State</source>
        <translation>状态</translation>
    </message>
    <message>
        <source>Customer</source>
        <translation>送校单位</translation>
    </message>
    <message>
        <source>Device</source>
        <translation>被校对象</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>出厂编号</translation>
    </message>
    <message>
        <source>Received</source>
        <translation>接收日期</translation>
    </message>
    <message>
        <source>Import a recording</source>
        <translation>导入记录</translation>
    </message>
    <message>
        <source>Recordings (*.ahrsrec recording.toml)</source>
        <translation>记录 (*.ahrsrec recording.toml)</translation>
    </message>
    <message>
        <source>No jobs yet</source>
        <translation>尚无任务</translation>
    </message>
    <message>
        <source>Each device that is received becomes a job here, from its order to its certificate.</source>
        <translation>每台接收的设备在这里成为一个任务，从委托直到证书。</translation>
    </message>
    <message>
        <source>New job</source>
        <translation>新建任务</translation>
    </message>
    <message>
        <source>Search number, customer, device</source>
        <translation>搜索编号、送校单位、设备</translation>
    </message>
    <message>
        <source>Search</source>
        <translation>搜索</translation>
    </message>
    <message>
        <source>Import a recording …</source>
        <translation>导入记录…</translation>
    </message>
    <message>
        <source>No job has these words.</source>
        <translation>没有任务含有这些字词。</translation>
    </message>
</context>
<context>
    <name>KindForm</name>
    <message>
        <source>Settings</source>
        <translation>设置</translation>
    </message>
    <message>
        <source>Defaults</source>
        <translation>默认值</translation>
    </message>
</context>
<context>
    <name>KindList</name>
    <message>
        <source>No recording</source>
        <translation>无需记录</translation>
    </message>
</context>
<context>
    <name>Language</name>
    <message>
        <source>en</source>
        <translation>zh</translation>
    </message>
</context>
<context>
    <name>LanguageView</name>
    <message>
        <source>no reply</source>
        <translation>无应答</translation>
    </message>
    <message>
        <source>Language of the table</source>
        <translation>转台指令集</translation>
    </message>
    <message>
        <source>Each text is said to the table and its reply is shown. {rate} and {angle} are filled in; several texts of one command stand apart by |. Those that turn or point move the table.</source>
        <translation>逐条向转台发送指令并显示应答。{rate} 和 {angle} 会被填入数值；同一命令的多条指令用 | 分隔。转动和定位指令会使转台运动。</translation>
    </message>
    <message>
        <source>Rate to try, °/s</source>
        <translation>试用角速率，°/s</translation>
    </message>
    <message>
        <source>Angle to try, °</source>
        <translation>试用角度，°</translation>
    </message>
    <message>
        <source>Save and connect again</source>
        <translation>保存并重新连接</translation>
    </message>
    <message>
        <source>Try</source>
        <translation>试发</translation>
    </message>
    <message>
        <source>How the reply to the query is read (regular expression)</source>
        <translation>查询应答的解析方式（正则表达式）</translation>
    </message>
    <message>
        <source>How a good reply begins</source>
        <translation>正常应答的形式</translation>
    </message>
</context>
<context>
    <name>LimitLine</name>
    <message>
        <source>fraction</source>
        <translation>比值</translation>
    </message>
    <message>
        <source>K, all axes</source>
        <translation>K，各轴</translation>
    </message>
    <message>
        <source>B, all axes</source>
        <translation>B，各轴</translation>
    </message>
    <message>
        <source>L, all pairs</source>
        <translation>L，各轴对</translation>
    </message>
    <message>
        <source>Quantity</source>
        <translation>量</translation>
    </message>
    <message>
        <source>Lower limit</source>
        <translation>下限</translation>
    </message>
    <message>
        <source>Upper limit</source>
        <translation>上限</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>单位</translation>
    </message>
    <message>
        <source>Nominal value</source>
        <translation>标称值</translation>
    </message>
    <message>
        <source>Take this limit away</source>
        <translation>删除此限值</translation>
    </message>
</context>
<context>
    <name>LimitsForm</name>
    <message>
        <source>Limits</source>
        <translation>限值</translation>
    </message>
    <message>
        <source>Decision rule</source>
        <translation>判定规则</translation>
    </message>
    <message>
        <source>Units on the certificate</source>
        <translation>证书上的单位</translation>
    </message>
    <message>
        <source>Without limits there is no statement of conformity. A limit of one axis goes before that of its group; a bound that is left empty is open.</source>
        <translation>不设限值则不作符合性判定。单个轴的限值优先于整组的限值；空着的一侧不设限。</translation>
    </message>
    <message>
        <source>Add a limit</source>
        <translation>添加限值</translation>
    </message>
    <message>
        <source>Rule (ILAC-G8)</source>
        <translation>规则（ILAC-G8）</translation>
    </message>
    <message>
        <source>r, multiple of U</source>
        <translation>r（U 的倍数）</translation>
    </message>
    <message>
        <source>State the conformance probability</source>
        <translation>给出符合概率</translation>
    </message>
    <message>
        <source>U of the zero offset includes its repeatability (another day)</source>
        <translation>零偏的 U 包含其重复性（他日的变化）</translation>
    </message>
    <message>
        <source>all the usual ones</source>
        <translation>各常用单位</translation>
    </message>
    <message>
        <source>Scale factor</source>
        <translation>标度因数</translation>
    </message>
    <message>
        <source>as delivered</source>
        <translation>按输出</translation>
    </message>
    <message>
        <source>also ppm from 1</source>
        <translation>另给出与 1 之差（ppm）</translation>
    </message>
    <message>
        <source>Zero offset</source>
        <translation>零偏</translation>
    </message>
    <message>
        <source>Misalignment</source>
        <translation>失准角</translation>
    </message>
</context>
<context>
    <name>LiveCard</name>
    <message>
        <source>gyro {axis}</source>
        <translation>陀螺 {axis}</translation>
    </message>
    <message>
        <source>table</source>
        <translation>转台</translation>
    </message>
    <message>
        <source>Live, last minute</source>
        <translation>实时曲线，最近一分钟</translation>
    </message>
    <message>
        <source>At {time} s</source>
        <translation>{time} s 处</translation>
    </message>
    <message>
        <source>Held</source>
        <translation>已定格</translation>
    </message>
    <message>
        <source>Hold</source>
        <translation>定格</translation>
    </message>
    <message>
        <source>Freeze the picture; recording goes on (H)</source>
        <translation>定格画面，记录照常进行 (H)</translation>
    </message>
    <message>
        <source>gyro, {unit}</source>
        <translation>陀螺，{unit}</translation>
    </message>
    <message>
        <source>table, {unit}</source>
        <translation>转台，{unit}</translation>
    </message>
</context>
<context>
    <name>MainWindow</name>
    <message>
        <source>AHRS Lab: calibration to JJF 1536-2015</source>
        <translation>航姿仪实验室：按 JJF 1536-2015 校准</translation>
    </message>
    <message>
        <source>A run is going on</source>
        <translation>正在运行</translation>
    </message>
    <message>
        <source>A run is going on.</source>
        <translation>校准正在运行。</translation>
    </message>
    <message>
        <source>Closing stops the table and switches the supply off. What is recorded is kept, and the run can be resumed later.</source>
        <translation>关闭程序将停止转台并断开电源。已记录的数据均保留，以后可以继续运行。</translation>
    </message>
    <message>
        <source>Stop the bench and close</source>
        <translation>停止台架并关闭</translation>
    </message>
    <message>
        <source>Go on with the run</source>
        <translation>继续运行</translation>
    </message>
    <message>
        <source>The bench has not come to rest yet. Use the hardware emergency stop if the table still turns.</source>
        <translation>台架尚未静止。若转台仍在转动，请使用硬件急停按钮。</translation>
    </message>
</context>
<context>
    <name>MonteCarloView</name>
    <message>
        <source>Deviation from the value, {unit}</source>
        <translation>与结果值之差，{unit}</translation>
    </message>
    <message>
        <source>{trials} trials, u = {u}: ± U is validated (JCGM 101, clause 8, δ = {tolerance}).</source>
        <translation>{trials} 次试验，u = {u}：± U 通过验证（JCGM 101 第 8 章，δ = {tolerance}）。</translation>
    </message>
    <message>
        <source>Both ends of ± U lie within δ of the symmetric interval&apos;s.</source>
        <translation>± U 的两端与对称区间的两端之差均在 δ 以内。</translation>
    </message>
    <message>
        <source>{trials} trials, u = {u}: ± U is not validated (JCGM 101, clause 8, δ = {tolerance}).</source>
        <translation>{trials} 次试验，u = {u}：± U 未通过验证（JCGM 101 第 8 章，δ = {tolerance}）。</translation>
    </message>
    <message>
        <source>± U of the GUM is too short: the U reported covers the symmetric interval.</source>
        <translation>GUM 的 ±U 偏短：报告的 U 覆盖对称区间。</translation>
    </message>
    <message>
        <source>An end of ± U lies more than δ from the symmetric interval&apos;s.</source>
        <translation>± U 的一端与对称区间的一端之差超过 δ。</translation>
    </message>
    <message>
        <source>Annex A of the standard has no Monte Carlo check: it is made of uncertainties by the GUM.</source>
        <translation>按规范附录 A 评定的不确定度没有蒙特卡洛检查：只有按 GUM 评定时才进行。</translation>
    </message>
    <message>
        <source>This result has no Monte Carlo check: it was evaluated without one. Calculate again to see the histogram here.</source>
        <translation>本结果没有蒙特卡洛检查：评定时未进行。重新计算后，此处将显示直方图。</translation>
    </message>
    <message>
        <source>± U (GUM)</source>
        <translation>± U（GUM）</translation>
    </message>
    <message>
        <source>95 % symmetric</source>
        <translation>95 % 对称区间</translation>
    </message>
    <message>
        <source>95 % shortest</source>
        <translation>95 % 最短区间</translation>
    </message>
</context>
<context>
    <name>MountView</name>
    <message>
        <source>Noted, going on …</source>
        <translation>已确认，继续…</translation>
    </message>
    <message>
        <source>Mounted</source>
        <translation>已装夹</translation>
    </message>
    <message>
        <source>Space</source>
        <translation>空格</translation>
    </message>
    <message>
        <source>What if it differs?</source>
        <translation>若不一致怎么办？</translation>
    </message>
    <message>
        <source>When power is back the sensor tells which axis it feels upward. If that is not the axis asked for, nothing is recorded: the drawing comes back with what the sensor feels. Check the axes printed on the case, not the outline; turn the case, tighten it, and say “Mounted” again.

If it stands as drawn and the sensor still disagrees, the device&apos;s axes may be named differently: stop the run and correct the device in the job.</source>
        <translation>恢复供电后，传感器会告知哪个轴朝天。若与要求的轴不符，则不作任何记录：图示会再次出现，并注明传感器的感受。请查看机壳上标注的坐标轴，而不要只看外形；翻转机壳、拧紧，再按“已装夹”。

若装夹与图示一致而传感器仍不相符，可能是设备的坐标轴命名不同：请停止运行，并在任务中更正被校对象。</translation>
    </message>
</context>
<context>
    <name>NameDialog</name>
    <message>
        <source>Name</source>
        <translation>名称</translation>
    </message>
    <message>
        <source>New bench</source>
        <translation>新建台架</translation>
    </message>
    <message>
        <source>A bench is a rate table, a power supply, a room sensor and the device under calibration.</source>
        <translation>一个台架由转台、直流电源、温湿度计和被校设备组成。</translation>
    </message>
    <message>
        <source>Make it</source>
        <translation>新建</translation>
    </message>
    <message>
        <source>There is a bench of that name already.</source>
        <translation>已有同名台架。</translation>
    </message>
</context>
<context>
    <name>NowCard</name>
    <message>
        <source>Stopping</source>
        <translation>正在停止</translation>
    </message>
    <message>
        <source>The table comes to rest, then the supply goes off.</source>
        <translation>转台先停，随后断开电源。</translation>
    </message>
    <message>
        <source>Paused</source>
        <translation>已暂停</translation>
    </message>
    <message>
        <source>The bench waits. What is recorded is on disk.</source>
        <translation>台架等待中。已记录的数据均在磁盘上。</translation>
    </message>
    <message>
        <source>Getting ready</source>
        <translation>准备中</translation>
    </message>
    <message>
        <source>The run is stopped. Only you can stop this table; then the supply goes off.</source>
        <translation>运行已停止。此转台只能由您停下；随后电源关闭。</translation>
    </message>
    <message>
        <source>Mount the case with {axis} pointing up</source>
        <translation>装夹机壳，使 {axis} 轴朝天</translation>
    </message>
    <message>
        <source>Mount the case with {axis} pointing down</source>
        <translation>装夹机壳，使 {axis} 轴朝地</translation>
    </message>
    <message>
        <source>Power stays on: mind the cable. The table is held at its north mark.</source>
        <translation>电源保持接通：请注意电缆。转台锁定在指北位置。</translation>
    </message>
    <message>
        <source>Power is off. Turn the fixture, tighten it, plug in again. The table is held at its north mark.</source>
        <translation>电源已断开。请翻转夹具、拧紧并重新接好插头。转台锁定在指北位置。</translation>
    </message>
    <message>
        <source>Pausing after this …</source>
        <translation>本步之后暂停…</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>暂停</translation>
    </message>
    <message>
        <source>No run yet</source>
        <translation>尚无运行</translation>
    </message>
    <message>
        <source>Here the application leads through a calibration: what to mount, what is measured, how it goes.</source>
        <translation>程序在这里引导整个校准：如何装夹、正在测量什么、进展如何。</translation>
    </message>
    <message>
        <source>Choose a job</source>
        <translation>选择任务</translation>
    </message>
    <message>
        <source>Pause before the next command (P)</source>
        <translation>在下一条指令之前暂停 (P)</translation>
    </message>
</context>
<context>
    <name>NumberField</name>
    <message>
        <source>a number, please</source>
        <translation>请输入数字</translation>
    </message>
</context>
<context>
    <name>OrderForm</name>
    <message>
        <source>not chosen</source>
        <translation>未选择</translation>
    </message>
    <message>
        <source>Customer</source>
        <translation>送校单位</translation>
    </message>
    <message>
        <source>Device</source>
        <translation>被校对象</translation>
    </message>
    <message>
        <source>Receipt and place</source>
        <translation>接收与地点</translation>
    </message>
    <message>
        <source>Who signs</source>
        <translation>签名人员</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>名称</translation>
    </message>
    <message>
        <source>Name in English</source>
        <translation>英文名称</translation>
    </message>
    <message>
        <source>Address</source>
        <translation>地址</translation>
    </message>
    <message>
        <source>Address in English</source>
        <translation>英文地址</translation>
    </message>
    <message>
        <source>Name of the device</source>
        <translation>设备名称</translation>
    </message>
    <message>
        <source>Manufacturer</source>
        <translation>制造厂</translation>
    </message>
    <message>
        <source>Model</source>
        <translation>型号</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>出厂编号</translation>
    </message>
    <message>
        <source>Received on</source>
        <translation>接收日期</translation>
    </message>
    <message>
        <source>Place of calibration</source>
        <translation>校准地点</translation>
    </message>
    <message>
        <source>Place in English</source>
        <translation>英文地点</translation>
    </message>
</context>
<context>
    <name>OutcomeCard</name>
    <message>
        <source>1 warning</source>
        <translation>1 条警告</translation>
    </message>
    <message>
        <source>{count} warnings</source>
        <translation>{count} 条警告</translation>
    </message>
    <message>
        <source>Settings changed</source>
        <translation>设置已更改</translation>
    </message>
    <message>
        <source>These are the results of other settings: run the analysis again.</source>
        <translation>当前结果对应更改前的设置：请重新运行分析。</translation>
    </message>
    <message>
        <source>Tables and charts will be here: choose what to analyse on the left, then run it.</source>
        <translation>这里将显示表格和曲线：请在左侧选择要分析的记录，然后运行。</translation>
    </message>
    <message>
        <source>Tables and charts will be here: check the settings on the left, then run it.</source>
        <translation>这里将显示表格和曲线：请在左侧确认设置，然后运行。</translation>
    </message>
    <message>
        <source>Save…</source>
        <translation>保存…</translation>
    </message>
</context>
<context>
    <name>Page</name>
    <message>
        <source>Start</source>
        <translation>首页</translation>
    </message>
    <message>
        <source>Jobs</source>
        <translation>任务</translation>
    </message>
    <message>
        <source>Run</source>
        <translation>运行</translation>
    </message>
    <message>
        <source>Results</source>
        <translation>结果</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>证书</translation>
    </message>
    <message>
        <source>Analyse</source>
        <translation>分析</translation>
    </message>
    <message>
        <source>Bench</source>
        <translation>台架</translation>
    </message>
    <message>
        <source>Instruments</source>
        <translation>仪器</translation>
    </message>
    <message>
        <source>Set-up</source>
        <translation>设置</translation>
    </message>
</context>
<context>
    <name>PartRow</name>
    <message>
        <source>Settings of this instrument</source>
        <translation>此仪器的设置</translation>
    </message>
    <message>
        <source>none yet</source>
        <translation>尚未添加</translation>
    </message>
    <message>
        <source>Add …</source>
        <translation>添加…</translation>
    </message>
    <message>
        <source>Disconnect</source>
        <translation>断开</translation>
    </message>
    <message>
        <source>Connect</source>
        <translation>连接</translation>
    </message>
</context>
<context>
    <name>PeoplePanel</name>
    <message>
        <source>Name</source>
        <translation>姓名</translation>
    </message>
    <message>
        <source>Name in English</source>
        <translation>英文姓名</translation>
    </message>
    <message>
        <source>Position</source>
        <translation>职务</translation>
    </message>
    <message>
        <source>Roles</source>
        <translation>角色</translation>
    </message>
    <message>
        <source>State</source>
        <translation>状态</translation>
    </message>
    <message>
        <source>active</source>
        <translation>在岗</translation>
    </message>
    <message>
        <source>left</source>
        <translation>离岗</translation>
    </message>
    <message>
        <source>Three different people sign a certificate: operator, verifier, approver.</source>
        <translation>一份证书由三人签名：校准员、核验员、签发人。</translation>
    </message>
    <message>
        <source>Edit</source>
        <translation>编辑</translation>
    </message>
    <message>
        <source>New person</source>
        <translation>新增人员</translation>
    </message>
</context>
<context>
    <name>PersonDialog</name>
    <message>
        <source>Name</source>
        <translation>姓名</translation>
    </message>
    <message>
        <source>Name in English</source>
        <translation>英文姓名</translation>
    </message>
    <message>
        <source>Position</source>
        <translation>职务</translation>
    </message>
    <message>
        <source>Position in English</source>
        <translation>英文职务</translation>
    </message>
    <message>
        <source>Empty: the password stays.</source>
        <translation>留空：密码不变。</translation>
    </message>
    <message>
        <source>It also locks the signing key.</source>
        <translation>密码同时保护签名密钥。</translation>
    </message>
    <message>
        <source>Password</source>
        <translation>密码</translation>
    </message>
    <message>
        <source>works here</source>
        <translation>在岗</translation>
    </message>
    <message>
        <source>Edit person</source>
        <translation>编辑人员</translation>
    </message>
    <message>
        <source>New person</source>
        <translation>新增人员</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>保存</translation>
    </message>
</context>
<context>
    <name>PlanForm</name>
    <message>
        <source>Back to the form</source>
        <translation>返回表单</translation>
    </message>
    <message>
        <source>All settings as text (TOML)</source>
        <translation>以文本编辑全部设置（TOML）</translation>
    </message>
    <message>
        <source>Enter a number.</source>
        <translation>请输入数字。</translation>
    </message>
    <message>
        <source>Enter a whole number.</source>
        <translation>请输入整数。</translation>
    </message>
    <message>
        <source>Enter rates separated by commas.</source>
        <translation>请输入以逗号分隔的速率。</translation>
    </message>
    <message>
        <source>Standard</source>
        <translation>标准</translation>
    </message>
    <message>
        <source>Accelerated (demonstration)</source>
        <translation>加速（演示）</translation>
    </message>
    <message>
        <source>Combined zero offset</source>
        <translation>组合零偏</translation>
    </message>
    <message>
        <source>Discrete IMU calibration</source>
        <translation>惯性测量组合分立标定</translation>
    </message>
    <message>
        <source>choose a preset …</source>
        <translation>选择预设…</translation>
    </message>
    <message>
        <source>Plan and mounting</source>
        <translation>方案与装夹</translation>
    </message>
    <message>
        <source>Scale factor (7.1)</source>
        <translation>标度因数（7.1）</translation>
    </message>
    <message>
        <source>Zero offset (7.2)</source>
        <translation>零偏（7.2）</translation>
    </message>
    <message>
        <source>Misalignment (7.3)</source>
        <translation>失准角（7.3）</translation>
    </message>
    <message>
        <source>Whole turns and positions (2.6.3)</source>
        <translation>整周转动与静态位置（2.6.3）</translation>
    </message>
    <message>
        <source>Take over a preset</source>
        <translation>采用预设</translation>
    </message>
    <message>
        <source>Procedure</source>
        <translation>校准方法</translation>
    </message>
    <message>
        <source>JJF 1536-2015: scale factor, zero offset, misalignment</source>
        <translation>JJF 1536—2015：标度因数、零偏、失准角</translation>
    </message>
    <message>
        <source>Discrete IMU calibration: gyros and accelerometers</source>
        <translation>惯性测量组合分立标定：陀螺与加速度计</translation>
    </message>
    <message>
        <source>Own positions: where x, y, z point</source>
        <translation>自定义位置：x、y、z 轴的指向</translation>
    </message>
    <message>
        <source>For example UEN, DES, NUE@30; @ is by how many degrees the table is turned on.</source>
        <translation>例如 UEN, DES, NUE@30；@ 后为转台继续转过的角度（度）。</translation>
    </message>
    <message>
        <source>Time at each position, s</source>
        <translation>每个位置的时间，s</translation>
    </message>
    <message>
        <source>Order of mountings</source>
        <translation>装夹顺序</translation>
    </message>
    <message>
        <source>Power while re-mounting</source>
        <translation>重新装夹时的电源</translation>
    </message>
    <message>
        <source>Warm-up, s</source>
        <translation>预热，s</translation>
    </message>
    <message>
        <source>Rates, °/s</source>
        <translation>速率点，°/s</translation>
    </message>
    <message>
        <source>Order of rates</source>
        <translation>速率顺序</translation>
    </message>
    <message>
        <source>Dwell at each rate, s</source>
        <translation>每个速率点的测量时间，s</translation>
    </message>
    <message>
        <source>Rest before and after, s</source>
        <translation>前后静止时间，s</translation>
    </message>
    <message>
        <source>Schedule</source>
        <translation>测量安排</translation>
    </message>
    <message>
        <source>T of each position, s</source>
        <translation>每个位置的 T，s</translation>
    </message>
    <message>
        <source>Positions</source>
        <translation>位置数</translation>
    </message>
    <message>
        <source>Repeats</source>
        <translation>重复次数</translation>
    </message>
    <message>
        <source>Rate, °/s</source>
        <translation>速率，°/s</translation>
    </message>
    <message>
        <source>Whole turns each way</source>
        <translation>每个方向的整圈数</translation>
    </message>
    <message>
        <source>± pairs</source>
        <translation>正反成对</translation>
    </message>
    <message>
        <source>ascending</source>
        <translation>递增</translation>
    </message>
    <message>
        <source>as listed</source>
        <translation>按列出顺序</translation>
    </message>
    <message>
        <source>combined: 4 positions</source>
        <translation>组合：4 个位置</translation>
    </message>
    <message>
        <source>multi-position</source>
        <translation>多位置</translation>
    </message>
    <message>
        <source>fewest mountings</source>
        <translation>装夹次数最少</translation>
    </message>
    <message>
        <source>off</source>
        <translation>断开</translation>
    </message>
    <message>
        <source>stays on</source>
        <translation>保持接通</translation>
    </message>
    <message>
        <source>8 (table 2-12)</source>
        <translation>8（表 2-12）</translation>
    </message>
    <message>
        <source>own list</source>
        <translation>自定义</translation>
    </message>
    <message>
        <source>standard: 12 positions</source>
        <translation>标准：12 个位置</translation>
    </message>
    <message>
        <source>as in the standard</source>
        <translation>按规范</translation>
    </message>
</context>
<context>
    <name>PlotView</name>
    <message>
        <source>Raw segment {name}, {count} samples</source>
        <translation>原始数据段 {name}，{count} 个样本</translation>
    </message>
    <message>
        <source>{symbol}: fit and residuals</source>
        <translation>{symbol}：拟合与残差</translation>
    </message>
    <message>
        <source>{symbol}: positions</source>
        <translation>{symbol}：各位置</translation>
    </message>
    <message>
        <source>{symbol}: turns in both senses</source>
        <translation>{symbol}：正反转</translation>
    </message>
    <message>
        <source>Click a point to open its raw segment.</source>
        <translation>点击数据点可打开其原始数据段。</translation>
    </message>
    <message>
        <source>Where U({symbol}) comes from</source>
        <translation>U({symbol}) 的来源</translation>
    </message>
    <message>
        <source>all others</source>
        <translation>其余</translation>
    </message>
    <message>
        <source>nonlinearity {ppm} ppm</source>
        <translation>非线性 {ppm} ppm</translation>
    </message>
    <message>
        <source>asymmetry {ppm} ppm</source>
        <translation>不对称性 {ppm} ppm</translation>
    </message>
    <message>
        <source>band: ± U; circles: B and the Earth&apos;s rate</source>
        <translation>色带：± U；圆圈：B 与地球自转角速度</translation>
    </message>
    <message>
        <source>positions: {count}</source>
        <translation>位置数：{count}</translation>
    </message>
    <message>
        <source>T = {time} each</source>
        <translation>每个位置 T = {time}</translation>
    </message>
    <message>
        <source>repeatability {rate} °/h</source>
        <translation>重复性 {rate} °/h</translation>
    </message>
    <message>
        <source>turns each way: {count}</source>
        <translation>每方向圈数：{count}</translation>
    </message>
    <message>
        <source>Residuals</source>
        <translation>残差</translation>
    </message>
    <message>
        <source>Fit</source>
        <translation>拟合</translation>
    </message>
    <message>
        <source>Back to the plot</source>
        <translation>返回图</translation>
    </message>
</context>
<context>
    <name>Plots</name>
    <message>
        <source>Table rate, °/s</source>
        <translation>转台速率，°/s</translation>
    </message>
    <message>
        <source>Order of recording</source>
        <translation>记录顺序</translation>
    </message>
    <message>
        <source>Start after the first rate, min</source>
        <translation>自第一个速率点起的时间，min</translation>
    </message>
    <message>
        <source>Residual, ppm</source>
        <translation>残差，ppm</translation>
    </message>
    <message>
        <source>Recording</source>
        <translation>记录</translation>
    </message>
    <message>
        <source>Residual, °/h</source>
        <translation>残差，°/h</translation>
    </message>
    <message>
        <source>Azimuth of the table, °</source>
        <translation>转台方位，°</translation>
    </message>
    <message>
        <source>Averaging time τ, s</source>
        <translation>平均时间 τ，s</translation>
    </message>
    <message>
        <source>Allan deviation, °/h</source>
        <translation>阿伦偏差，°/h</translation>
    </message>
    <message>
        <source>Mean output, {unit}</source>
        <translation>输出均值，{unit}</translation>
    </message>
    <message>
        <source>Azimuth of the axis, °</source>
        <translation>轴的方位，°</translation>
    </message>
    <message>
        <source>Mean output, °/h</source>
        <translation>输出均值，°/h</translation>
    </message>
    <message>
        <source>east</source>
        <translation>东</translation>
    </message>
    <message>
        <source>west</source>
        <translation>西</translation>
    </message>
    <message>
        <source>north</source>
        <translation>北</translation>
    </message>
    <message>
        <source>south</source>
        <translation>南</translation>
    </message>
    <message>
        <source>up</source>
        <translation>天</translation>
    </message>
    <message>
        <source>down</source>
        <translation>地</translation>
    </message>
    <message>
        <source>Angle shown by {axis}, °</source>
        <translation>{axis} 输出角，°</translation>
    </message>
    <message>
        <source>+{rate} °/s</source>
        <translation>+{rate} °/s</translation>
    </message>
    <message>
        <source>−{rate} °/s</source>
        <translation>−{rate} °/s</translation>
    </message>
    <message>
        <source>Time in the segment, s</source>
        <translation>段内时间，s</translation>
    </message>
    <message>
        <source>Output, {unit}</source>
        <translation>输出，{unit}</translation>
    </message>
</context>
<context>
    <name>ProfilePanel</name>
    <message>
        <source>Saved.</source>
        <translation>已保存。</translation>
    </message>
    <message>
        <source>Name and address stand on every certificate. An administrator changes them.</source>
        <translation>名称和地址印在每份证书上，由管理员修改。</translation>
    </message>
    <message>
        <source>Name of the laboratory</source>
        <translation>实验室名称</translation>
    </message>
    <message>
        <source>Name in English</source>
        <translation>英文名称</translation>
    </message>
    <message>
        <source>Address</source>
        <translation>地址</translation>
    </message>
    <message>
        <source>Address in English</source>
        <translation>英文地址</translation>
    </message>
    <message>
        <source>Place of the table (clause 6)</source>
        <translation>转台场地（第 6 章）</translation>
    </message>
    <message>
        <source>Recorded with each run and printed on its certificate; a real bench does not start without it unless a second person says why.</source>
        <translation>随每次运行记录并印在证书上；实际台架未声明时，须由第二人说明理由方可开始。</translation>
    </message>
    <message>
        <source>Earth resistance, Ω</source>
        <translation>接地电阻，Ω</translation>
    </message>
    <message>
        <source>Has to be below 4 Ω.</source>
        <translation>应小于 4 Ω。</translation>
    </message>
    <message>
        <source>Table on an isolated foundation</source>
        <translation>转台置于独立地基上</translation>
    </message>
    <message>
        <source>Not said</source>
        <translation>未声明</translation>
    </message>
    <message>
        <source>Yes</source>
        <translation>是</translation>
    </message>
    <message>
        <source>No</source>
        <translation>否</translation>
    </message>
    <message>
        <source>Best measurement capability (CMC)</source>
        <translation>最佳测量能力（CMC）</translation>
    </message>
    <message>
        <source>Expanded uncertainties, k = 2: no U is reported below them. Empty: none is stated.</source>
        <translation>扩展不确定度，k = 2：报告的 U 不小于此值。空着表示未声明。</translation>
    </message>
    <message>
        <source>Scale factor, relative</source>
        <translation>标度因数（相对）</translation>
    </message>
    <message>
        <source>Zero offset, °/s</source>
        <translation>零偏（°/s）</translation>
    </message>
    <message>
        <source>Misalignment, rad</source>
        <translation>失准角（rad）</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>保存</translation>
    </message>
</context>
<context>
    <name>Question</name>
    <message>
        <source>Cancel</source>
        <translation>取消</translation>
    </message>
</context>
<context>
    <name>ReadingsCard</name>
    <message>
        <source>off</source>
        <translation>断开</translation>
    </message>
    <message>
        <source>Gyro {axis}, mean of 1 s</source>
        <translation>陀螺 {axis}，1 s 均值</translation>
    </message>
    <message>
        <source>Bench time to the end</source>
        <translation>距结束的台架时间</translation>
    </message>
    <message>
        <source>Bench time to the next mounting</source>
        <translation>距下次装夹的台架时间</translation>
    </message>
    <message>
        <source>After this you are free until</source>
        <translation>装夹之后您可以离开，直到</translation>
    </message>
    <message>
        <source>The run ends at</source>
        <translation>运行结束于</translation>
    </message>
    <message>
        <source>You are free until</source>
        <translation>您可以离开，直到</translation>
    </message>
    <message>
        <source>next: turn to {face}</source>
        <translation>下一步：翻转为 {face}</translation>
    </message>
    <message>
        <source>now</source>
        <translation>现在</translation>
    </message>
    <message>
        <source>no other mounting follows</source>
        <translation>之后不再装夹</translation>
    </message>
    <message>
        <source>Readings</source>
        <translation>读数</translation>
    </message>
    <message>
        <source>Table rate, demanded</source>
        <translation>转台速率，设定</translation>
    </message>
    <message>
        <source>Table rate, actual</source>
        <translation>转台速率，实际</translation>
    </message>
    <message>
        <source>Table angle</source>
        <translation>转台角度</translation>
    </message>
    <message>
        <source>Samples, this segment</source>
        <translation>本段样本</translation>
    </message>
    <message>
        <source>Lost</source>
        <translation>丢失</translation>
    </message>
    <message>
        <source>Supply</source>
        <translation>电源</translation>
    </message>
    <message>
        <source>Room</source>
        <translation>环境</translation>
    </message>
    <message>
        <source>This step</source>
        <translation>本步骤</translation>
    </message>
    <message>
        <source>Until you are needed</source>
        <translation>距下次需要您</translation>
    </message>
    <message>
        <source>Whole run</source>
        <translation>整个运行</translation>
    </message>
</context>
<context>
    <name>ReasonDialog</name>
    <message>
        <source>Reason</source>
        <translation>理由</translation>
    </message>
    <message>
        <source>It goes into the record and onto the certificate.</source>
        <translation>理由将写入原始记录和证书。</translation>
    </message>
    <message>
        <source>Second person</source>
        <translation>第二人</translation>
    </message>
    <message>
        <source>Password of the second person</source>
        <translation>第二人的密码</translation>
    </message>
    <message>
        <source>The bench violates clause 6</source>
        <translation>台架不符合第 6 章</translation>
    </message>
    <message>
        <source>The job starts only when a second person gives a reason.</source>
        <translation>只有第二人给出理由，任务才能开始。</translation>
    </message>
    <message>
        <source>Accept and start</source>
        <translation>接受并开始</translation>
    </message>
    <message>
        <source>Give the reason.</source>
        <translation>请填写理由。</translation>
    </message>
    <message>
        <source>Enter the password.</source>
        <translation>请输入密码。</translation>
    </message>
</context>
<context>
    <name>RecordView</name>
    <message>
        <source>Mean of gyro {axis} so far</source>
        <translation>陀螺 {axis} 目前均值</translation>
    </message>
    <message>
        <source>± {error} standard error</source>
        <translation>± {error} 标准误差</translation>
    </message>
    <message>
        <source>{left} left of {whole}</source>
        <translation>剩余 {left}，共 {whole}</translation>
    </message>
</context>
<context>
    <name>RecordingField</name>
    <message>
        <source>none chosen</source>
        <translation>未选择</translation>
    </message>
    <message>
        <source>Choose a recording.</source>
        <translation>请选择记录。</translation>
    </message>
    <message>
        <source>Recording folder</source>
        <translation>记录文件夹</translation>
    </message>
    <message>
        <source>Recording file</source>
        <translation>记录文件</translation>
    </message>
    <message>
        <source>Recordings (*.ahrsrec recording.toml)</source>
        <translation>记录 (*.ahrsrec recording.toml)</translation>
    </message>
    <message>
        <source>Look for a recording</source>
        <translation>查找记录</translation>
    </message>
    <message>
        <source>Folder…</source>
        <translation>文件夹…</translation>
    </message>
    <message>
        <source>File (.ahrsrec)…</source>
        <translation>文件 (.ahrsrec)…</translation>
    </message>
</context>
<context>
    <name>Recordings</name>
    <message>
        <source>Job {number}</source>
        <translation>任务 {number}</translation>
    </message>
</context>
<context>
    <name>RepeatDialog</name>
    <message>
        <source>Repeat a segment</source>
        <translation>重测数据段</translation>
    </message>
    <message>
        <source>Both takes are kept; the new one counts.</source>
        <translation>两次测量均保留，以新的一次为准。</translation>
    </message>
    <message>
        <source>Segment</source>
        <translation>数据段</translation>
    </message>
    <message>
        <source>Reason</source>
        <translation>理由</translation>
    </message>
    <message>
        <source>for example: somebody leant on the table</source>
        <translation>例如：有人碰到了转台</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>取消</translation>
    </message>
    <message>
        <source>Record it again</source>
        <translation>重新记录</translation>
    </message>
</context>
<context>
    <name>ReportTable</name>
    <message>
        <source>Copy the table</source>
        <translation>复制表格</translation>
    </message>
</context>
<context>
    <name>ReportView</name>
    <message>
        <source>Show all</source>
        <translation>显示全部</translation>
    </message>
</context>
<context>
    <name>ResultsPage</name>
    <message>
        <source>Save as</source>
        <translation>另存为</translation>
    </message>
    <message>
        <source>Tables for a spreadsheet (*.csv)</source>
        <translation>电子表格文件 (*.csv)</translation>
    </message>
    <message>
        <source>Saved as {path}.</source>
        <translation>已另存为 {path}。</translation>
    </message>
    <message>
        <source>Not measured yet</source>
        <translation>尚未测量</translation>
    </message>
    <message>
        <source>Scale factors, zero offsets and misalignments of this job will be here, each with its uncertainty and its plot.</source>
        <translation>本任务的标度因数、零偏和失准角将在这里，各附不确定度和图。</translation>
    </message>
    <message>
        <source>Prepare and start</source>
        <translation>准备并开始</translation>
    </message>
    <message>
        <source>No job is open</source>
        <translation>没有打开的任务</translation>
    </message>
    <message>
        <source>Open a job to see its scale factors, zero offsets and misalignments.</source>
        <translation>打开任务即可查看其标度因数、零偏和失准角。</translation>
    </message>
    <message>
        <source>Choose a job</source>
        <translation>选择任务</translation>
    </message>
    <message>
        <source>Evaluating the recording</source>
        <translation>正在处理记录</translation>
    </message>
    <message>
        <source>Scale factor</source>
        <translation>标度因数</translation>
    </message>
    <message>
        <source>Zero offset</source>
        <translation>零偏</translation>
    </message>
    <message>
        <source>Misalignment</source>
        <translation>失准角</translation>
    </message>
    <message>
        <source>Not part of this calibration.</source>
        <translation>不属于本次校准。</translation>
    </message>
    <message>
        <source>Plot</source>
        <translation>图</translation>
    </message>
    <message>
        <source>Values</source>
        <translation>数值</translation>
    </message>
    <message>
        <source>Uncertainty budget</source>
        <translation>不确定度评定</translation>
    </message>
    <message>
        <source>Diagnosis</source>
        <translation>诊断</translation>
    </message>
    <message>
        <source>Warnings and deviations</source>
        <translation>警告与偏离</translation>
    </message>
    <message>
        <source>Calculate again</source>
        <translation>重新计算</translation>
    </message>
    <message>
        <source>GUM</source>
        <translation>GUM</translation>
    </message>
    <message>
        <source>annex A</source>
        <translation>附录 A</translation>
    </message>
    <message>
        <source>demanded rates</source>
        <translation>设定速率</translation>
    </message>
    <message>
        <source>rates of the table</source>
        <translation>转台实测速率</translation>
    </message>
</context>
<context>
    <name>RoomView</name>
    <message>
        <source>Room now</source>
        <translation>室内环境</translation>
    </message>
    <message>
        <source>Temperature</source>
        <translation>温度</translation>
    </message>
    <message>
        <source>Humidity</source>
        <translation>湿度</translation>
    </message>
    <message>
        <source>Read off and typed in</source>
        <translation>读数后手动输入</translation>
    </message>
    <message>
        <source>Temperature, °C</source>
        <translation>温度，°C</translation>
    </message>
    <message>
        <source>Humidity, %RH</source>
        <translation>湿度，%RH</translation>
    </message>
    <message>
        <source>Enter</source>
        <translation>录入</translation>
    </message>
</context>
<context>
    <name>RunWords</name>
    <message>
        <source>{axis} up</source>
        <translation>{axis} 轴朝天</translation>
    </message>
    <message>
        <source>{axis} down</source>
        <translation>{axis} 轴朝地</translation>
    </message>
    <message>
        <source>east</source>
        <translation>东</translation>
    </message>
    <message>
        <source>north</source>
        <translation>北</translation>
    </message>
    <message>
        <source>up</source>
        <translation>天</translation>
    </message>
    <message>
        <source>west</source>
        <translation>西</translation>
    </message>
    <message>
        <source>south</source>
        <translation>南</translation>
    </message>
    <message>
        <source>down</source>
        <translation>地</translation>
    </message>
    <message>
        <source>{axis} {direction}</source>
        <translation>{axis} {direction}</translation>
    </message>
    <message>
        <source>, </source>
        <translation>，</translation>
    </message>
    <message>
        <source>mount</source>
        <translation>装夹</translation>
    </message>
    <message>
        <source>power on, warm up</source>
        <translation>通电预热</translation>
    </message>
    <message>
        <source>{axis} at rest</source>
        <translation>{axis} 静止</translation>
    </message>
    <message>
        <source>{axis} rates</source>
        <translation>{axis} 速率点</translation>
    </message>
    <message>
        <source>{axis} turns {turns}</source>
        <translation>{axis} 转 {turns} 周</translation>
    </message>
    <message>
        <source>{axis} zero offset, {position}</source>
        <translation>{axis} 零偏 {position}</translation>
    </message>
    <message>
        <source>at rest, {position}</source>
        <translation>静置，{position}</translation>
    </message>
    <message>
        <source>{axis} with the table at rest</source>
        <translation>转台静止，测 {axis}</translation>
    </message>
    <message>
        <source>{axis} at {rate} °/s</source>
        <translation>{axis} 轴，{rate} °/s</translation>
    </message>
    <message>
        <source>{n} turns about {axis} at {rate} °/s</source>
        <translation>绕 {axis} 轴转 {n} 周，{rate} °/s</translation>
    </message>
    <message>
        <source>Position {n} at rest</source>
        <translation>静态位置 {n}</translation>
    </message>
    <message>
        <source>Zero offset of {axis}, position {n}</source>
        <translation>{axis} 轴零偏，位置 {n}</translation>
    </message>
    <message>
        <source>Scale factor (7.1). {standing}.</source>
        <translation>标度因数（7.1）。{standing}。</translation>
    </message>
    <message>
        <source>Zero offset (7.2). {standing}.</source>
        <translation>零偏（7.2）。{standing}。</translation>
    </message>
    <message>
        <source>Misalignment (7.3). {standing}.</source>
        <translation>失准角（7.3）。{standing}。</translation>
    </message>
    <message>
        <source>Rates of the IMU (2.6.3.1). {standing}.</source>
        <translation>惯性测量组合速率标定（2.6.3.1）。{standing}。</translation>
    </message>
    <message>
        <source>Positions of the IMU (2.6.3.2). {standing}.</source>
        <translation>惯性测量组合位置标定（2.6.3.2）。{standing}。</translation>
    </message>
</context>
<context>
    <name>SendBackDialog</name>
    <message>
        <source>Reason</source>
        <translation>理由</translation>
    </message>
    <message>
        <source>Send job {number} back</source>
        <translation>退回任务 {number}</translation>
    </message>
    <message>
        <source>The signed file stays; the operator lays out and signs a new revision.</source>
        <translation>已签名的文件保留；校准员重新出具并签名新版本。</translation>
    </message>
    <message>
        <source>Send back</source>
        <translation>退回</translation>
    </message>
    <message>
        <source>Give the reason.</source>
        <translation>请填写理由。</translation>
    </message>
</context>
<context>
    <name>SetupPage</name>
    <message>
        <source>Set-up</source>
        <translation>设置</translation>
    </message>
    <message>
        <source>Standards</source>
        <translation>标准器</translation>
    </message>
    <message>
        <source>People</source>
        <translation>人员</translation>
    </message>
    <message>
        <source>Laboratory</source>
        <translation>实验室</translation>
    </message>
    <message>
        <source>Screen</source>
        <translation>界面</translation>
    </message>
    <message>
        <source>Language</source>
        <translation>语言</translation>
    </message>
    <message>
        <source>Appearance</source>
        <translation>外观</translation>
    </message>
    <message>
        <source>Light</source>
        <translation>浅色</translation>
    </message>
    <message>
        <source>Dark</source>
        <translation>深色</translation>
    </message>
    <message>
        <source>As the system</source>
        <translation>跟随系统</translation>
    </message>
</context>
<context>
    <name>SignDialog</name>
    <message>
        <source>Password of {name}</source>
        <translation>{name}的密码</translation>
    </message>
    <message>
        <source>Your signature fixes the content of the certificate.</source>
        <translation>您的签名将固定证书内容。</translation>
    </message>
    <message>
        <source>You confirm that you have checked the result, its deviations and its data.</source>
        <translation>您确认已核验结果、偏离及其数据。</translation>
    </message>
    <message>
        <source>Your signature issues the certificate; nothing can be added afterwards.</source>
        <translation>您的签名将签发证书，此后不能再作任何添加。</translation>
    </message>
    <message>
        <source>Sign as {role}</source>
        <translation>以{role}身份签名</translation>
    </message>
    <message>
        <source>Sign</source>
        <translation>签名</translation>
    </message>
    <message>
        <source>Enter the password.</source>
        <translation>请输入密码。</translation>
    </message>
</context>
<context>
    <name>SignInDialog</name>
    <message>
        <source>Name</source>
        <translation>姓名</translation>
    </message>
    <message>
        <source>Password</source>
        <translation>密码</translation>
    </message>
    <message>
        <source>Sign in</source>
        <translation>登录</translation>
    </message>
    <message>
        <source>Enter the password.</source>
        <translation>请输入密码。</translation>
    </message>
</context>
<context>
    <name>SignPanel</name>
    <message>
        <source>not chosen</source>
        <translation>未选择</translation>
    </message>
    <message>
        <source>signed</source>
        <translation>已签名</translation>
    </message>
    <message>
        <source>your turn</source>
        <translation>轮到您</translation>
    </message>
    <message>
        <source>waits</source>
        <translation>等待中</translation>
    </message>
    <message>
        <source>later</source>
        <translation>稍后</translation>
    </message>
    <message>
        <source>Finish the run first</source>
        <translation>请先完成本次运行</translation>
    </message>
    <message>
        <source>missing</source>
        <translation>缺失</translation>
    </message>
    <message>
        <source>Certify and sign</source>
        <translation>确认并签名</translation>
    </message>
    <message>
        <source>Checked: sign</source>
        <translation>核验并签名</translation>
    </message>
    <message>
        <source>Approve and issue</source>
        <translation>批准并签发</translation>
    </message>
    <message>
        <source>Sign in as this person</source>
        <translation>以此人登录</translation>
    </message>
</context>
<context>
    <name>StandardDialog</name>
    <message>
        <source>Edit standard</source>
        <translation>编辑标准器</translation>
    </message>
    <message>
        <source>New standard</source>
        <translation>新增标准器</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>保存</translation>
    </message>
    <message>
        <source>Kind</source>
        <translation>类别</translation>
    </message>
    <message>
        <source>Name in English</source>
        <translation>英文名称</translation>
    </message>
    <message>
        <source>Name in Chinese</source>
        <translation>中文名称</translation>
    </message>
    <message>
        <source>Manufacturer</source>
        <translation>制造厂</translation>
    </message>
    <message>
        <source>Model</source>
        <translation>型号</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>出厂编号</translation>
    </message>
    <message>
        <source>Accuracy (English)</source>
        <translation>准确度（英文）</translation>
    </message>
    <message>
        <source>Accuracy (Chinese)</source>
        <translation>准确度（中文）</translation>
    </message>
    <message>
        <source>Certificate number</source>
        <translation>证书编号</translation>
    </message>
    <message>
        <source>Traceable to</source>
        <translation>溯源至</translation>
    </message>
    <message>
        <source>Due date</source>
        <translation>有效期至</translation>
    </message>
    <message>
        <source>year-month-day; empty: none</source>
        <translation>年-月-日；留空：无</translation>
    </message>
    <message>
        <source>Write the date as 2027-03-31.</source>
        <translation>日期请写成 2027-03-31。</translation>
    </message>
</context>
<context>
    <name>StandardsForm</name>
    <message>
        <source>no certificate</source>
        <translation>无证书</translation>
    </message>
    <message>
        <source>no due date</source>
        <translation>无有效期</translation>
    </message>
    <message>
        <source>expired {date}</source>
        <translation>已于 {date} 过期</translation>
    </message>
    <message>
        <source>valid until {date}</source>
        <translation>有效期至 {date}</translation>
    </message>
    <message>
        <source>Clause 6 asks for a table, a supply and a fixture, each with a certificate that has not run out.</source>
        <translation>第 6 章要求转台、电源和夹具，且证书均在有效期内。</translation>
    </message>
    <message>
        <source>Edit the laboratory&apos;s standards</source>
        <translation>编辑实验室标准器</translation>
    </message>
</context>
<context>
    <name>StandardsPanel</name>
    <message>
        <source>Name</source>
        <translation>名称</translation>
    </message>
    <message>
        <source>Model</source>
        <translation>型号</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>出厂编号</translation>
    </message>
    <message>
        <source>Accuracy</source>
        <translation>准确度</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>证书</translation>
    </message>
    <message>
        <source>Due</source>
        <translation>有效期</translation>
    </message>
    <message>
        <source>no due date</source>
        <translation>无有效期</translation>
    </message>
    <message>
        <source>{date} expired</source>
        <translation>{date} 已过期</translation>
    </message>
    <message>
        <source>What the bench is traceable to; jobs choose from these.</source>
        <translation>台架的溯源依据；任务从中选用。</translation>
    </message>
    <message>
        <source>Edit</source>
        <translation>编辑</translation>
    </message>
    <message>
        <source>New standard</source>
        <translation>新增标准器</translation>
    </message>
</context>
<context>
    <name>StartPage</name>
    <message>
        <source>No jobs yet</source>
        <translation>尚无任务</translation>
    </message>
    <message>
        <source>What the laboratory has to do will be here: devices to measure, results to verify, certificates to approve.</source>
        <translation>实验室的待办事项将在这里：待测设备、待核验结果、待签发证书。</translation>
    </message>
    <message>
        <source>New job</source>
        <translation>新建任务</translation>
    </message>
    <message>
        <source>To do</source>
        <translation>待办</translation>
    </message>
    <message>
        <source>To measure</source>
        <translation>待测量</translation>
    </message>
    <message>
        <source>Nothing waits for the bench.</source>
        <translation>没有等待测量的任务。</translation>
    </message>
    <message>
        <source>To verify</source>
        <translation>待核验</translation>
    </message>
    <message>
        <source>No result waits for its check.</source>
        <translation>没有等待核验的结果。</translation>
    </message>
    <message>
        <source>To approve</source>
        <translation>待签发</translation>
    </message>
    <message>
        <source>No certificate waits for approval.</source>
        <translation>没有等待签发的证书。</translation>
    </message>
    <message>
        <source>Issued last</source>
        <translation>最近签发</translation>
    </message>
    <message>
        <source>Simulated bench</source>
        <translation>仿真台架</translation>
    </message>
    <message>
        <source>The demonstration&apos;s table, supply, room and unit are simulated: each of its results and certificates says so.</source>
        <translation>演示所用的转台、电源、环境和航姿仪均为仿真：其每份结果和证书都会注明。</translation>
    </message>
    <message>
        <source>Look at the bench</source>
        <translation>查看台架</translation>
    </message>
    <message>
        <source>Complete the job</source>
        <translation>补全任务</translation>
    </message>
    <message>
        <source>Prepare and start</source>
        <translation>准备并开始</translation>
    </message>
    <message>
        <source>Go to the run</source>
        <translation>转到运行</translation>
    </message>
    <message>
        <source>Look at the result</source>
        <translation>查看结果数据</translation>
    </message>
    <message>
        <source>Check and sign</source>
        <translation>核验与签名</translation>
    </message>
    <message>
        <source>Approve</source>
        <translation>签发</translation>
    </message>
</context>
<context>
    <name>StepsCard</name>
    <message>
        <source>Steps</source>
        <translation>步骤</translation>
    </message>
</context>
<context>
    <name>StepsList</name>
    <message>
        <source>Steps</source>
        <translation>步骤</translation>
    </message>
</context>
<context>
    <name>StopBar</name>
    <message>
        <source>STOP</source>
        <translation>停止</translation>
    </message>
    <message>
        <source>Esc</source>
        <translation>Esc</translation>
    </message>
    <message>
        <source>Bring the table to rest by hand; then the supply is switched off …</source>
        <translation>请手动使转台停止；随后断开电源 …</translation>
    </message>
    <message>
        <source>Stopping the table, then switching the supply off …</source>
        <translation>正在停止转台，随后断开电源…</translation>
    </message>
    <message>
        <source>No run is going on: there is nothing to stop.</source>
        <translation>没有正在进行的运行，无需停止。</translation>
    </message>
    <message>
        <source>Ends the run, then switches the supply off. This table only you can bring to rest.</source>
        <translation>结束运行，然后断开电源。此转台只能由您停下。</translation>
    </message>
    <message>
        <source>Stops the table, then switches the supply off. This is not the hardware emergency stop.</source>
        <translation>先停转台，再断电源。这不是硬件急停按钮。</translation>
    </message>
</context>
<context>
    <name>SupplyView</name>
    <message>
        <source>not connected</source>
        <translation>未连接</translation>
    </message>
    <message>
        <source>output on</source>
        <translation>输出开</translation>
    </message>
    <message>
        <source>output off</source>
        <translation>输出关</translation>
    </message>
    <message>
        <source>Power supply now</source>
        <translation>直流电源</translation>
    </message>
    <message>
        <source>Voltage</source>
        <translation>电压</translation>
    </message>
    <message>
        <source>Current</source>
        <translation>电流</translation>
    </message>
    <message>
        <source>Power of the device</source>
        <translation>设备供电</translation>
    </message>
    <message>
        <source>Voltage, V</source>
        <translation>电压，V</translation>
    </message>
    <message>
        <source>Current limit, A</source>
        <translation>限流，A</translation>
    </message>
    <message>
        <source>Switch on</source>
        <translation>打开输出</translation>
    </message>
    <message>
        <source>Switch off</source>
        <translation>关闭输出</translation>
    </message>
</context>
<context>
    <name>TableView</name>
    <message>
        <source>Switch the drive off</source>
        <translation>断开转台使能</translation>
    </message>
    <message>
        <source>Switch the drive on</source>
        <translation>转台上电使能</translation>
    </message>
    <message>
        <source>not connected</source>
        <translation>未连接</translation>
    </message>
    <message>
        <source>set by hand: nothing can stop it but you</source>
        <translation>手动转台：只有您能使其停止</translation>
    </message>
    <message>
        <source>supervisor watches</source>
        <translation>监护进程正在监护</translation>
    </message>
    <message>
        <source>no supervisor: a crash leaves the table turning</source>
        <translation>无监护进程：程序崩溃时转台不会停</translation>
    </message>
    <message>
        <source>Rate table now</source>
        <translation>转台状态</translation>
    </message>
    <message>
        <source>Rate</source>
        <translation>角速率</translation>
    </message>
    <message>
        <source>Demanded</source>
        <translation>设定值</translation>
    </message>
    <message>
        <source>Angle</source>
        <translation>角度</translation>
    </message>
    <message>
        <source>Move by hand</source>
        <translation>手动控制</translation>
    </message>
    <message>
        <source>Table set by hand</source>
        <translation>手动设定的转台</translation>
    </message>
    <message>
        <source>You set the rate at the table itself; during a run the device on it checks that it is right.</source>
        <translation>由您在转台上设定角速率；运行时由台上的设备核对是否正确。</translation>
    </message>
    <message>
        <source>Rate to set, °/s</source>
        <translation>要设定的角速率，°/s</translation>
    </message>
    <message>
        <source>Ask for it</source>
        <translation>请求设定</translation>
    </message>
    <message>
        <source>Done: the table does that</source>
        <translation>已完成设定</translation>
    </message>
    <message>
        <source>Rate while held, °/s</source>
        <translation>按住时的角速率，°/s</translation>
    </message>
    <message>
        <source>Hold: clockwise</source>
        <translation>按住：顺时针</translation>
    </message>
    <message>
        <source>Hold: anticlockwise</source>
        <translation>按住：逆时针</translation>
    </message>
    <message>
        <source>Go to angle, °</source>
        <translation>转到角度，°</translation>
    </message>
    <message>
        <source>with at most, °/s</source>
        <translation>最大角速率，°/s</translation>
    </message>
    <message>
        <source>Go</source>
        <translation>转到</translation>
    </message>
    <message>
        <source>Limit by hand, °/s</source>
        <translation>手动限速，°/s</translation>
    </message>
    <message>
        <source>Angle from, °</source>
        <translation>角度下限，°</translation>
    </message>
    <message>
        <source>to, °</source>
        <translation>角度上限，°</translation>
    </message>
    <message>
        <source>no end</source>
        <translation>无限制</translation>
    </message>
    <message>
        <source>Set limits</source>
        <translation>设置限值</translation>
    </message>
    <message>
        <source>The table stops when the button is let go, and by STOP (Esc). Neither is the hardware emergency stop: keep that one within reach.</source>
        <translation>松开按钮或按停止键（Esc）时转台停止。两者都不是硬件急停：请确保急停按钮随手可及。</translation>
    </message>
</context>
<context>
    <name>TextSetting</name>
    <message>
        <source>Choose a file</source>
        <translation>选择文件</translation>
    </message>
</context>
<context>
    <name>ValuesView</name>
    <message>
        <source>Quantity</source>
        <translation>量</translation>
    </message>
    <message>
        <source>Symbol</source>
        <translation>符号</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>值</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>单位</translation>
    </message>
    <message>
        <source>Scale factor of axis {axis}</source>
        <translation>{axis} 轴标度因数</translation>
    </message>
    <message>
        <source>Zero offset of axis {axis} ({angle})</source>
        <translation>{axis} 轴零偏（{angle}）</translation>
    </message>
    <message>
        <source>Misalignment of axis {turned} to axis {output}</source>
        <translation>{turned} 轴对 {output} 轴的失准角</translation>
    </message>
</context>
<context>
    <name>Verdict</name>
    <message>
        <source>Certificate preview</source>
        <translation>证书预览</translation>
    </message>
    <message>
        <source>Conformity cannot be stated</source>
        <translation>无法作出符合性判定</translation>
    </message>
    <message>
        <source>Values: {count}</source>
        <translation>数值：{count}</translation>
    </message>
    <message>
        <source>Measured; no limits are set</source>
        <translation>已测量；未设限值</translation>
    </message>
    <message>
        <source>Not all that has a limit was calibrated</source>
        <translation>有限值的参数未全部校准</translation>
    </message>
    <message>
        <source>Pass: all values within their limits</source>
        <translation>合格：全部数值符合限值</translation>
    </message>
    <message>
        <source>Conditional pass</source>
        <translation>有条件合格</translation>
    </message>
    <message>
        <source>Conditional fail</source>
        <translation>有条件不合格</translation>
    </message>
    <message>
        <source>Fail: not all values conform</source>
        <translation>不合格：有数值不符合</translation>
    </message>
    <message>
        <source>{passed} of {count} pass</source>
        <translation>{count} 项中 {passed} 项合格</translation>
    </message>
    <message>
        <source>not calibrated: {quantities}</source>
        <translation>未校准：{quantities}</translation>
    </message>
    <message>
        <source>uncertainty by annex A</source>
        <translation>不确定度按附录 A</translation>
    </message>
    <message>
        <source>uncertainty by the GUM</source>
        <translation>不确定度按 GUM</translation>
    </message>
    <message>
        <source>deviations from the standard: {count}</source>
        <translation>与规范的偏离：{count}</translation>
    </message>
    <message>
        <source>warnings: {count}</source>
        <translation>警告：{count}</translation>
    </message>
    <message>
        <source>U raised to the CMC: {count}</source>
        <translation>U 提高到 CMC：{count}</translation>
    </message>
    <message>
        <source>simulated bench</source>
        <translation>仿真台架</translation>
    </message>
</context>
<context>
    <name>VerdictCard</name>
    <message>
        <source>A preview: nothing is signed yet.</source>
        <translation>预览：尚未签名。</translation>
    </message>
    <message>
        <source>The signatures are being checked.</source>
        <translation>正在核查签名。</translation>
    </message>
    <message>
        <source>Intact; not yet signed: {roles}</source>
        <translation>完整；尚未签名：{roles}</translation>
    </message>
    <message>
        <source>Intact and unchanged since the last signature</source>
        <translation>完整，自最后一次签名后未被改动</translation>
    </message>
    <message>
        <source>{role}: {name}, {when}</source>
        <translation>{role}：{name}，{when}</translation>
    </message>
    <message>
        <source>the signer is not known to this laboratory</source>
        <translation>本实验室不认识该签名人</translation>
    </message>
    <message>
        <source>Verification</source>
        <translation>验证</translation>
    </message>
    <message>
        <source>Verify again</source>
        <translation>重新验证</translation>
    </message>
</context>
<context>
    <name>WhatIfStrip</name>
    <message>
        <source>What if: U = {expanded} (k = {k}) instead of {before}. Not the result; nothing is stored.</source>
        <translation>假如：U = {expanded}（k = {k}），而不是 {before}。这不是结果，不会保存。</translation>
    </message>
    <message>
        <source>What if: U = {expanded} (k = {k}), unchanged. Not the result; nothing is stored.</source>
        <translation>假如：U = {expanded}（k = {k}），没有变化。这不是结果，不会保存。</translation>
    </message>
    <message>
        <source>Reset</source>
        <translation>还原</translation>
    </message>
</context>
<context>
    <name>Words</name>
    <message>
        <source>, </source>
        <translation>、</translation>
    </message>
    <message>
        <source>Operator</source>
        <translation>校准员</translation>
    </message>
    <message>
        <source>Verifier</source>
        <translation>核验员</translation>
    </message>
    <message>
        <source>Approver</source>
        <translation>签发人</translation>
    </message>
    <message>
        <source>Administrator</source>
        <translation>管理员</translation>
    </message>
    <message>
        <source>Draft</source>
        <translation>草稿</translation>
    </message>
    <message>
        <source>Ready</source>
        <translation>就绪</translation>
    </message>
    <message>
        <source>Running</source>
        <translation>运行中</translation>
    </message>
    <message>
        <source>Measured</source>
        <translation>已测量</translation>
    </message>
    <message>
        <source>Checked</source>
        <translation>已核验</translation>
    </message>
    <message>
        <source>Issued</source>
        <translation>已签发</translation>
    </message>
    <message>
        <source>Single-axis position and rate table</source>
        <translation>单轴位置速率转台</translation>
    </message>
    <message>
        <source>DC power supply</source>
        <translation>直流电源</translation>
    </message>
    <message>
        <source>Mounting fixture</source>
        <translation>安装夹具</translation>
    </message>
    <message>
        <source>Thermometer and hygrometer</source>
        <translation>温湿度计</translation>
    </message>
    <message>
        <source>North reference</source>
        <translation>北向基准</translation>
    </message>
    <message>
        <source>Other</source>
        <translation>其他</translation>
    </message>
    <message>
        <source>heading</source>
        <translation>航向</translation>
    </message>
    <message>
        <source>pitch</source>
        <translation>俯仰</translation>
    </message>
    <message>
        <source>roll</source>
        <translation>横滚</translation>
    </message>
    <message>
        <source>single-axis position and rate table</source>
        <translation>单轴位置速率转台</translation>
    </message>
    <message>
        <source>DC supply</source>
        <translation>直流电源</translation>
    </message>
    <message>
        <source>{name} (simulated)</source>
        <translation>{name}（仿真）</translation>
    </message>
    <message>
        <source>Pass</source>
        <translation>合格</translation>
    </message>
    <message>
        <source>Conditional pass</source>
        <translation>有条件合格</translation>
    </message>
    <message>
        <source>Conditional fail</source>
        <translation>有条件不合格</translation>
    </message>
    <message>
        <source>Fail</source>
        <translation>不合格</translation>
    </message>
    <message>
        <source>Cond. pass</source>
        <translation>有条件合格</translation>
    </message>
    <message>
        <source>Cond. fail</source>
        <translation>有条件不合格</translation>
    </message>
    <message>
        <source>Simple acceptance</source>
        <translation>简单接受</translation>
    </message>
    <message>
        <source>Guard band w = r·U</source>
        <translation>保护带 w = r·U</translation>
    </message>
    <message>
        <source>Non-binary, guard band w = r·U</source>
        <translation>非二元判定，保护带 w = r·U</translation>
    </message>
    <message>
        <source>The table&apos;s drive trips and brakes</source>
        <translation>转台驱动跳闸并制动</translation>
    </message>
    <message>
        <source>The table&apos;s rate never settles</source>
        <translation>转台速率始终不稳定</translation>
    </message>
    <message>
        <source>The table ignores commands</source>
        <translation>转台不响应指令</translation>
    </message>
    <message>
        <source>The table does not stop</source>
        <translation>转台不停止</translation>
    </message>
    <message>
        <source>The supply current never settles</source>
        <translation>电源电流始终不稳定</translation>
    </message>
    <message>
        <source>The device goes silent</source>
        <translation>被校对象无输出</translation>
    </message>
    <message>
        <source>One sample in ten is lost</source>
        <translation>每十个样本丢失一个</translation>
    </message>
    <message>
        <source>The case is mounted wrongly</source>
        <translation>机壳装夹错误</translation>
    </message>
    <message>
        <source>A table set by hand turns the wrong way</source>
        <translation>手动转台转向错误</translation>
    </message>
    <message>
        <source>The room is at 26 °C and 90 %RH</source>
        <translation>环境为 26 °C、90 %RH</translation>
    </message>
</context>
<context>
    <name>WorkView</name>
    <message>
        <source>{time} left</source>
        <translation>剩余 {time}</translation>
    </message>
</context>
<context>
    <name>Workbench</name>
    <message>
        <source>Folder for the files</source>
        <translation>保存文件的文件夹</translation>
    </message>
    <message>
        <source>The folder holds a recording {names} already: choose another.</source>
        <translation>该文件夹中已有记录 {names}：请另选文件夹。</translation>
    </message>
    <message>
        <source>Replace files</source>
        <translation>替换文件</translation>
    </message>
    <message>
        <source>The folder holds already: {names}.</source>
        <translation>该文件夹中已有：{names}。</translation>
    </message>
    <message>
        <source>Replace</source>
        <translation>替换</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>取消</translation>
    </message>
    <message>
        <source>Saved in {folder}: {names}.</source>
        <translation>已保存到 {folder}：{names}。</translation>
    </message>
    <message>
        <source>No recording: {names}. A recording is a folder with recording.toml in it, or an .ahrsrec file.</source>
        <translation>不是记录：{names}。记录是内含 recording.toml 的文件夹，或 .ahrsrec 文件。</translation>
    </message>
    <message>
        <source>Analyses</source>
        <translation>分析项目</translation>
    </message>
    <message>
        <source>Run</source>
        <translation>运行</translation>
    </message>
    <message>
        <source>The charts follow the settings.</source>
        <translation>曲线随设置实时更新。</translation>
    </message>
</context>
<context>
    <name>_PausedView</name>
    <message>
        <source>The table rests and the supply stays on until you go on.</source>
        <translation>在您继续之前，转台静止，电源保持接通。</translation>
    </message>
    <message>
        <source>Go on</source>
        <translation>继续</translation>
    </message>
</context>
<context>
    <name>_TaskPanel</name>
    <message>
        <source>received {date}</source>
        <translation>接收于 {date}</translation>
    </message>
</context>
</TS>
